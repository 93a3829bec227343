"""Cylinders of engines: the cycles of their gas over the angle of the crank, and where the crank puts their pistons."""
