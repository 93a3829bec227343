"""Imports: mechanisms of other programs, turned into a mechanism.py that people can read."""
