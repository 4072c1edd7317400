"""One module a command: load, compute, render, print once. Heavy imports stand inside the
functions.
"""
