"""Checks before a version is tagged: made in a clean clone, each failure by its name."""
