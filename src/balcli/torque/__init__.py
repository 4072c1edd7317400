"""Torque on the crank over a cycle, from gas and inertia or from a given curve, the speed that it
makes uneven, and the flywheel that evens it.
"""
