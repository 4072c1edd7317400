"""Analyze an `Engine`: each function returns one complete, frozen result."""
