"""An engine file and what may change in, the best arrangements out."""
