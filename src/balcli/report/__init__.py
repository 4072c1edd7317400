"""Pictures, and a self-contained HTML page of an engine: forces, balance, mounts, torsion, gas."""
