"""Build an `Engine` (SI arrays, one row for each cylinder) from an engine file."""
