"""Clearance in space: paths of bodies, the search for the least gap of two meshes, facets apart by joints."""
