"""Compute the loads of an `Engine` on frame and crankshaft, by order and over the crank
angle.
"""
