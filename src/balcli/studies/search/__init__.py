"""Search: the best arrangements of an engine file."""
