"""Discs, balls and tyres, and what they touch: features and their solids."""
