"""Size devices that cancel free forces and moments of an `Engine`, by balance schemes."""
