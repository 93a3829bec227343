"""Tubes that change their shape: springs, ropes, belts, traces of points."""
