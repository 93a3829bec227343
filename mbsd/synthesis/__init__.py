"""Dimensional synthesis: the lengths with which a mechanism does what is asked for."""
