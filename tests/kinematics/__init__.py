"""Motions that drivers decide, their reactions, mobility."""
