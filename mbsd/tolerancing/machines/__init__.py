"""Machines with other dimensions, solved: all at once, one by one, simulated, or by a function of the user."""
