"""An order of layers, found by a satisfiability solver, and the heights that follow from it."""
