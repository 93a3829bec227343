"""Plots, report, GLB and gallery."""
