"""What tools left in the faces of a solid: chamfers, whose edges wear, and engraving, which is filled with paint."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

from typing import Any

import numpy as np

from render.blender.scene.materials import EDGE

Array = np.ndarray
SLOPE = 0.4, 0.93
"""Height of a chamfer's unit normal."""
DEPTH = 0.00015, 0.0007
"""How deep engraving is (m)."""
LEVEL = 0.999
"""Height of the unit normal of a level face."""


def mark_chamfers(mesh: Any) -> None:
    """Faces that slope between top and wall and end at a sharp edge are chamfers: the attribute EDGE is 1 there."""
    sharp = np.zeros(len(mesh.edges), bool)
    mesh.attributes["sharp_edge"].data.foreach_get("value", sharp)
    edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    slope = np.abs(_normals(mesh)[:, 2])
    ends = sharp[edges].reshape(-1, 3).any(axis=1)
    marks = (ends & (slope > SLOPE[0]) & (slope < SLOPE[1])).astype(np.float32)
    mesh.attributes.new(EDGE, "FLOAT", "FACE").data.foreach_set("value", marks)


def engraved(mesh: Any) -> Array:
    """Whether each triangle is the floor or a wall of what is engraved into the largest level face."""
    places = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", places.ravel())
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    heights = places[corners, 2].reshape(-1, 3)
    areas = np.empty(len(mesh.polygons), np.float32)
    mesh.polygons.foreach_get("area", areas)
    return sunk(heights, _normals(mesh)[:, 2], areas)


def sunk(heights: Array, up: Array, areas: Array) -> Array:
    """Whether each triangle is the floor or a wall of what is cut a little into the largest level face.

    ``heights`` (n, 3) are those of the corners (m), ``up`` (n,) those of the unit normals.
    """
    level = up > LEVEL
    if not level.any():
        return np.zeros(len(up), bool)
    steps, which = np.unique(np.round(heights[level, 0], 5), return_inverse=True)
    top = steps[np.bincount(which, areas[level]).argmax()]
    deep = top - heights
    floor = level & (deep > DEPTH[0]).all(axis=1) & (deep < DEPTH[1]).all(axis=1)
    wall = (np.abs(up) < 1 - LEVEL) & (deep > -1e-5).all(axis=1) & (deep < DEPTH[1]).all(axis=1)
    return floor | (wall & floor.any())


def _normals(mesh: Any) -> Array:
    normals = np.empty((len(mesh.polygons), 3), np.float32)
    mesh.polygon_normals.foreach_get("vector", normals.ravel())
    return normals
