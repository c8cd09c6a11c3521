"""Goals shown by demonstration, and look-then-move towards them."""
