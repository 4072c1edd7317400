"""The name of a printed coefficient table in, the table recomputed beside its print out, with
every printed figure that is wrong.
"""
