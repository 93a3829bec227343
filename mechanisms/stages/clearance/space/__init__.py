"""Clearance in space: paths of bodies, the search for the least gap of two meshes, and what joints keep apart."""
