"""Pictures, and a self-contained HTML page with the results of all chapters."""
