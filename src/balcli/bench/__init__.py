"""An engine file in, run time against error of every method out."""
