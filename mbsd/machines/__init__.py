"""Whole machines from a few numbers; the solver below knows nothing of them."""
