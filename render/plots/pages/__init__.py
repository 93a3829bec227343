"""Plots, a page a file."""
