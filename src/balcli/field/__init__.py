"""Field balancing: readings of a rotor on a machine in, correction weights and residuals out."""
