"""A result in, text out. One file a format; nothing here computes."""
