"""Recompute printed coefficient tables and list their errata."""
