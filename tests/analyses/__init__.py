"""Equilibrium, linearisation, given efforts."""
