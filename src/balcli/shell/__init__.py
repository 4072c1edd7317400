"""One module a command: load, compute, render, print once; what brings numpy or pydantic is
imported when a command runs, so that its help and the shell's completion need not wait for them.
"""
