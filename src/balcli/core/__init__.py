"""Kinematics, harmonics, phasors and inertia: numpy in, numpy out."""
