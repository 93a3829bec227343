"""Cylinders of engines: cycles of their gas over the crank angle, and positions of their pistons."""
