"""Drawings and animations of the skeleton."""
