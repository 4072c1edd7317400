"""Engine balance: free forces and moments of reciprocating engines, order by order, and what cancels them."""
__version__ = "0.1.0"
