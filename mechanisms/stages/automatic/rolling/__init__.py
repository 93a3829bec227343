"""Balls, wheels with tyres and discs, and what they touch."""
