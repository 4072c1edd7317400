"""Torsional vibration of engine or chain files: modes, critical speeds, forced response."""
