"""Compute correction weights from vibration readings of a rotor on its machine."""
