"""An `Engine` in, what it does to its frame and its crankshaft out, order by order and along the
crank angle.
"""
