"""Compute the torque on the crank over a cycle, from gas and inertia or from a given curve; the
fluctuation of speed that it causes, and the flywheel that limits it.
"""
