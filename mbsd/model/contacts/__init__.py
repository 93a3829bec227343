"""Unilateral contacts, which push but never pull, one file a kind, built of relative-pose constraints."""
