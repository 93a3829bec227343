"""Arrows, arcs and words of the film: what they stand for, and how long they are."""
