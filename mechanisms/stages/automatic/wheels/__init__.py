"""Gears, racks, belts and chains: features and their solids."""
