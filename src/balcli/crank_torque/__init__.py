"""Compute the torque on the crank over a cycle, from gas and inertia or from a given curve; the
fluctuation of speed that this torque causes, and the flywheel that limits the fluctuation.
"""
