"""Read TOML text into a checked model, in the file's own units, with every mistake by its
path.
"""
