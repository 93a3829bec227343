"""Simulations in space: reference coordinates with Euler parameters on the compiled loop of planar simulations."""
