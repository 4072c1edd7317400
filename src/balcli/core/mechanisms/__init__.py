"""The mechanisms between crank pin and piston pin: their motion and its harmonics."""
