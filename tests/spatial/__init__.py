"""Mechanisms in space against published numbers, closed forms, and differences."""
