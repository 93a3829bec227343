"""Solids of machines whose bodies have places along the normal (mm): made.py calls the others."""
