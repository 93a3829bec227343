"""Limits of a motion: limits and stops of joints, contacts, crossings of curves, wheels that meet."""
