"""Automatic parts for random mechanisms of all kinds: whether they fit, and reasons of refusals."""
