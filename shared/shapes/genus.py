"""Number of holes through a solid, counted on a coarse mesh, for shapes that follow from a mechanism."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from shared.shapes.facets import facets
from shared.shapes.rough_box import rough_size

if TYPE_CHECKING:
    import cadquery as cq

COARSE, ANGLE = 0.05, 0.6
"""Mesh: distance from the surface, in edges, for each mm of the size; largest angle between facets (rad)."""
SAME = 1e-7
"""Corners that are nearer than this part of the size are one."""


def through_holes(shape: cq.Workplane) -> int:
    """Return the through holes n of one closed solid: V - E + F of its mesh is 2 - 2 n."""
    solid = shape.solids().vals()[0]
    size = rough_size(shape.solids())
    corners = facets(solid, COARSE * size, ANGLE, relative=True).reshape(-1, 3).astype(float)
    places = np.round(corners / (SAME * size)).astype(np.int64)
    _, which = np.unique(places, axis=0, return_inverse=True)
    triples = which.reshape(-1, 3)
    edges = np.sort(np.concatenate([triples[:, [0, 1]], triples[:, [1, 2]], triples[:, [2, 0]]]), axis=1)
    count = len(np.unique(triples)) - len(np.unique(edges, axis=0)) + len(triples)
    return (2 - count) // 2
