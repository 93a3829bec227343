"""Relative coordinates of a spanning tree, by articulated bodies and the rows of cut joints."""
