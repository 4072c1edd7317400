"""Locomotives: balance masses in the wheels and the hammer blow that they leave."""
