"""Relative coordinates of a spanning tree as a formulation of the compiled loop: articulated bodies, rows of cut joints."""
