"""An `Engine` and a question in, one complete frozen answer out."""
