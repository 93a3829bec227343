"""Equations in space, compiled: Phi, J, nu and gamma of rows, and loads of bodies, on arrays.

One file for each term of a row; evaluation.py goes over all of them.
"""
