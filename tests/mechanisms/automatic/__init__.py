"""Automatic parts."""
