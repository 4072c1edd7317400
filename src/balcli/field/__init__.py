"""Readings of a rotor on a machine in, correction weights and what they leave out."""
