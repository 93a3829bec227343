"""Gears, racks, belts and chains."""
