"""Pieces that turn as they roll."""
