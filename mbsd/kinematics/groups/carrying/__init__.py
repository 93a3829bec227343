"""Shared parts of all groups' formulas: points that bodies carry, branches, cases of solution."""
