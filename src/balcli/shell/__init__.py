"""Code shared by commands and Python functions: typed values, input, output, progress."""
