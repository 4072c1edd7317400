"""Studies: quantities of many variants of an engine file."""
