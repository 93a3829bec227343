"""Quantities of simulations, measures of them, and rows that may end early."""
