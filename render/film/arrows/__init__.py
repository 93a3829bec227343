"""Arrows, arcs and words of the film: what they stand for, how long they are."""
