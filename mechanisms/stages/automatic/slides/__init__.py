"""Prismatic joints, pins in slots and along curves: features and their solids."""
