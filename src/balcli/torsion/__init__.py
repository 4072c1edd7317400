"""Torsional vibration: a chain file, or an engine file, goes in; modes, criticals, response out."""
