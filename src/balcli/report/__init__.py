"""Pictures and the page: results of all chapters, drawn."""
