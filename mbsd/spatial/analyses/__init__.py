"""Analyses in space: equilibrium, linearisation about it or a steady motion, and modes."""
