"""Motions that forces drive, between events and across them: linear equations along nodes, and jumps."""
