"""Events of the user for the compiled loop over simulations: their numbers, values and sides."""
