"""Tolerances of a mechanism: how far a result strays as its dimensions do, and which of them to tighten."""
