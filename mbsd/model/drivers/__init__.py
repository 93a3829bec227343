"""Drivers: what imposes a motion law on a freedom, one file a kind, each made of a constraint."""
