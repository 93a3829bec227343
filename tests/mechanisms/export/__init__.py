"""Mechanisms in the files of other programs."""
