"""Tubes as meshes of a glTF document."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from render.blender.scene.tubes import SIDES, vertices
from render.film.scene import TubeSpec
from render.glb.document import INDICES, VERTICES, Document
from render.glb.materials import Paints

Array = NDArray[np.float64]
Tube = tuple[Array, Array, NDArray[np.signedinteger]]
"""Positions and normals (n, 3), corners (m,)."""


def below(tube: Tube, place: float) -> Tube:
    """A tube without what is higher than ``place`` (m), closed by a flat cut face; without corners where all of it is.

    What is beyond is laid into the plane, and goes between rings that are wholly there: exact for a tube that stands
    upright, to within a facet for one that lies level, to within a ring for a coil.
    """
    positions, normals, corners = tube
    beyond = positions[:, 2] > place
    gone = beyond.reshape(-1, SIDES).all(axis=1)  # rings, then both ends
    gone[-2:] = gone[0] & gone[1], gone[-4] & gone[-3]
    triangles = corners.reshape(-1, 3)
    kept = triangles[~gone[triangles // SIDES].all(axis=1)]
    laid = np.column_stack([positions[:, :2], np.minimum(positions[:, 2], place)])
    return laid, np.where(beyond[:, None], [0.0, 0.0, 1.0], normals), kept.reshape(-1)


def tube_mesh(document: Document, paints: Paints, spec: TubeSpec, name: str, tubes: list[Tube]) -> int:
    """The number of a mesh; tubes beyond the first are shapes that it may be blended to."""
    (positions, normals, _), *others = tubes
    part = primitive(document, paints, spec, tubes[0])
    if others:
        part["targets"] = [
            {
                "POSITION": document.array((p - positions).astype(np.float32), VERTICES, bounds=True),
                "NORMAL": document.array((n - normals).astype(np.float32), VERTICES),
            }
            for p, n, _ in others
        ]
    mesh: dict[str, Any] = {"name": name, "primitives": [part]}
    if others:
        mesh["weights"] = [0.0] * len(others)
    return document.add("meshes", mesh)


def primitive(document: Document, paints: Paints, spec: TubeSpec, tube: Tube) -> dict[str, Any]:
    """A tube as a part of a mesh."""
    positions, normals, corners = tube
    return {
        "attributes": {
            "POSITION": document.array(positions.astype(np.float32), VERTICES, bounds=True),
            "NORMAL": document.array(normals.astype(np.float32), VERTICES),
        },
        "indices": document.array(corners.astype(np.uint16 if len(positions) < 65535 else np.uint32), INDICES),
        "material": paints.of(spec.surface),
    }


def tube(path: Array, radius: float) -> Tube:
    """Positions and normals (n, 3) and corners (m,) of a tube along a path (k, 3) with flat ends."""
    line = [(float(x), float(y), float(z)) for x, y, z in path]
    rings = vertices(line, radius).astype(float).reshape(-1, SIDES, 3)
    middles = np.asarray(path)[:, None]
    outwards = (rings - middles) / radius
    ends = [(path[0] - path[1]), (path[-1] - path[-2])]
    faces = [np.tile(end / np.linalg.norm(end), (SIDES, 1)) for end in ends]
    positions = np.concatenate([rings.reshape(-1, 3), rings[0], rings[-1]])
    normals = np.concatenate([outwards.reshape(-1, 3), *faces])
    side, following = np.arange(SIDES), (np.arange(SIDES) + 1) % SIDES
    quads = []
    for ring in range(len(path) - 1):
        a, b = ring * SIDES + side, ring * SIDES + following
        quads += [np.stack([a, b, b + SIDES], axis=1), np.stack([a, b + SIDES, a + SIDES], axis=1)]
    first, last = len(path) * SIDES, (len(path) + 1) * SIDES
    fan = np.stack([np.zeros(SIDES - 2, int), np.arange(1, SIDES - 1), np.arange(2, SIDES)], axis=1)
    corners = np.concatenate([*quads, first + fan[:, ::-1], last + fan])
    return positions, normals, corners.reshape(-1)
