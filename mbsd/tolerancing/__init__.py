"""Tolerances of a mechanism: the spread of a result by its dimensions, and which to tighten."""
