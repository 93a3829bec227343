"""Solution of mechanisms with other dimensions: all at once, singly, simulated, or by a function.

The function is the user's.
"""
