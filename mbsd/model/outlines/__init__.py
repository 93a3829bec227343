"""Outlines of bodies: their geometry, DXF files, features, and contacts of bodies of any shape."""
