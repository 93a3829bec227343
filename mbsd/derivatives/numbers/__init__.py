"""Mechanisms with another value of a number beside the one that moves, and what their equations leave over there."""
