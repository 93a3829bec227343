"""Compiled: accelerations and multipliers in reference coordinates, by the Schur complement of the masses."""
