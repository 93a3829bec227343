"""Draws the moving skeleton from mechanism.py alone. It imports loading and solve."""
