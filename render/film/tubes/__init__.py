"""What changes its shape: springs, ropes, belts, traces of points."""
