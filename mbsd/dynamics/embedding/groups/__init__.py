"""Compiled: the groups of independent coordinates by their pins and slides."""
