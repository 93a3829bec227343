"""Designs that a page shows without Python: motions on a grid of main numbers, with polynomials."""
