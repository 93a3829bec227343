"""Pins, rods, welds, bridges, studs of springs, and bodies that no joint shapes."""
