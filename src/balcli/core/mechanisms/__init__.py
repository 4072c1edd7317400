"""The mechanisms between crank pin and piston pin: geometry in, motion and its harmonics out."""
