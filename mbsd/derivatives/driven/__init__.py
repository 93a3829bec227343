"""Sweeps, whose tangents follow from the inverse of one Jacobian: positions, rates and multipliers row by row."""
