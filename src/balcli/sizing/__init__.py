"""An `Engine` and a scheme in, the devices that cancel its free forces and moments out."""
