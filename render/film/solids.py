"""Reads what the camera needs of the parts' STL files: their outlines and the space they sweep."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from shared.stage.errors import UserError

Array = NDArray[np.float64]
MILLIMETRE = 0.001
"""STL files are in millimetres, everything else here is in metres."""
DIRECTIONS, LEANS = 72, (-2.0, -1.0, -0.4, 0.0, 0.4, 1.0, 2.0)
"""In the plane, and how steeply up, in which points are looked for that are outermost."""
SIDES = 16
"""Number of sides of the polygon within which no corner of a hull is looked for."""
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_triangles(path: Path) -> Array:
    """Return corners (n, 3, 3) in m of the triangles of a binary STL.

    Raises UserError if the file is not whole.
    """
    content = path.read_bytes()
    count = int.from_bytes(content[80:84], "little") if len(content) >= 84 else -1
    if len(content) != 84 + _TRIANGLE.itemsize * count or count < 1:
        raise UserError(f"{path} is not a whole binary STL ({len(content)} bytes); make the parts again")
    return np.frombuffer(content, _TRIANGLE, count, 84)["corners"].astype(float) * MILLIMETRE


def read_corners(path: Path) -> Array:
    """Return corners (3 n, 3) in m of all triangles of a binary STL.

    Raises UserError if the file is not whole.
    """
    return read_triangles(path).reshape(-1, 3)


def prism(vertices: Array) -> Array:
    """Return the upright prism around vertices (n, 3).

    It is the convex outline in x, y at the lowest and the highest z.
    """
    outline = _convex_outline(vertices[:, :2])
    heights = vertices[:, 2].min(), vertices[:, 2].max()
    return np.concatenate([np.column_stack([outline, np.full(len(outline), z)]) for z in heights])


def outermost(points: Array) -> Array:
    """Return the points (n, 3) that are farthest in some direction.

    If they are longer in the plane than high, all are inside within two thousandths of their size.
    """
    angles = np.linspace(0.0, 2 * np.pi, DIRECTIONS, endpoint=False)
    ways = np.array([(np.cos(angle), np.sin(angle), lean) for angle in angles for lean in LEANS])
    ways = np.concatenate([ways, [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0)]])
    return points[np.unique((ways @ points.T).argmax(axis=1))]


def swept(outline: Array, poses: Array) -> Array:
    """Return all places (m * n, 3) of points (n, 3) over poses (m, 3) of x, y, theta."""
    cosine, sine = np.cos(poses[:, 2])[:, None], np.sin(poses[:, 2])[:, None]
    x = poses[:, 0, None] + cosine * outline[:, 0] - sine * outline[:, 1]
    y = poses[:, 1, None] + sine * outline[:, 0] + cosine * outline[:, 1]
    z = np.broadcast_to(outline[:, 2], x.shape)
    return np.stack([x, y, z], axis=-1).reshape(-1, 3)


def _convex_outline(points: Array) -> Array:
    """Return corners of the convex hull of points (n, 2), by Andrew's monotone chain."""
    ordered = np.unique(_not_inside(points), axis=0)
    if len(ordered) < 3:
        return ordered

    def chain(sequence: Array) -> list[Array]:
        kept: list[Array] = []
        for point in sequence:
            while len(kept) >= 2:
                a, b = kept[-1] - kept[-2], point - kept[-2]
                if a[0] * b[1] - a[1] * b[0] > 0:
                    break
                kept.pop()
            kept.append(point)
        return kept[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]))


def _not_inside(points: Array) -> Array:
    """Return the points (n, 2) outside a polygon of outermost ones (Akl, Toussaint 1978); most are inside."""
    ways = _around(SIDES)
    corners = points[(ways @ points.T).argmax(axis=1)]
    inside = np.full(len(points), bool((corners != corners[0]).any()))
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if (a != b).any():
            x, y = b - a
            inside &= x * (points[:, 1] - a[1]) - y * (points[:, 0] - a[0]) > 0
    return points[~inside]


def _around(count: int) -> Array:
    """Return so many directions (n, 2) in the plane."""
    angles = np.linspace(0.0, 2 * np.pi, count, endpoint=False)
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)
