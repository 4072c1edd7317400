"""Functions of the library: what a user of Python gives -> one call down the line -> an answer."""
