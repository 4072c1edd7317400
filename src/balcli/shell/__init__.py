"""What commands and Python functions share: typed values, files read, results written, progress."""
