"""Studies that evaluate quantities for many variants of an engine file."""
