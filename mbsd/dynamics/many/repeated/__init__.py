"""Rows of joints that repeat others in the compiled loop over simulations: which of them hold, and reactions."""
