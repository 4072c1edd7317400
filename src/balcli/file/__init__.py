"""Read TOML text into a checked model in the units of the file; mistakes are reported by path."""
