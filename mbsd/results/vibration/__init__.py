"""Shaking forces and moments of the frame, and their harmonics against the crank."""
