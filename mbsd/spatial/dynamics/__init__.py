"""Simulations in space: reference coordinates with Euler parameters on the planar compiled loop."""
