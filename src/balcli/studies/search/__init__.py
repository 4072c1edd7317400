"""Search for the best arrangements of an engine."""
