"""Needs of the project: libraries and programs of the system, and the packages that bring them."""
