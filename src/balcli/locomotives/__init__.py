"""Balance masses in the wheels of locomotives, and the hammer blow that they leave."""
