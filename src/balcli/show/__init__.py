"""Convert results to text, HTML, CSV, JSON and pictures; nothing is computed here."""
