"""Shared parts of the formulas of all groups: points that bodies carry, branches, and cases of solution."""
