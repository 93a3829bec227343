"""Mechanisms of other programs, read into a mechanism.py that people can read."""
