"""Webs of a crankshaft: from dimensions, drawing or scales to mass, unbalance and inertia."""
