"""Printed coefficient tables, recomputed and compared with their prints, with their errata."""
