"""A TOML text in, a checked model of what it says out, in the file's own units, with every mistake
by its path.
"""
