"""Kinematics, harmonics, forces and vibration, as functions of numpy arrays."""
