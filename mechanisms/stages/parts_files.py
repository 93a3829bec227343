"""Makes the bytes of a solid's files: equal solids give equal bytes, whenever and wherever."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from shared.shapes.facets import HEAD, TRIANGLE, cut_short, enclosed, facets, is_closed, ruled, volume_of
from shared.stage.errors import UserError

TOLERANCE = 0.018
"""Largest distance of the mesh from the true surface (mm), where a solid does not say otherwise."""
ANGLE = 0.3
"""Largest angle between neighbouring facets of a curved face (rad)."""
VOLUME_GOAL = 4.5e-3
"""Relative difference to the solid's volume at which a mesh is fine enough."""
FINER = (1.0, 2.0, 4.0)
"""Meshes that are tried for a solid, so many times as fine as asked."""
BESIDE = (1.5, 0.75, 3.0, 0.5)
"""Further ones where none of those is closed: the kernel loses a face where facets of two edges cross, which depends on
where it divides them."""

_PRODUCT = re.compile(rb"= PRODUCT\('[^']*',\s*'[^']*'")
_TIMESTAMP = re.compile(rb"(FILE_NAME\('[^']*',)'[^']*'")


def stl_bytes(solid: Any, tolerance: float | None = None) -> bytes:
    """Return binary STL of a ``cadquery.Solid``, in mm, its triangles in an order of their own.

    ``tolerance`` (mm) is :data:`TOLERANCE` by default. The mesh gets finer until it is closed and holds the solid's
    volume to :data:`VOLUME_GOAL`; the finest need only be closed. Where none is, the last that was tried is written.
    Raises UserError if the kernel cannot write its file.
    """
    volume, tolerance = volume_of(solid), tolerance or TOLERANCE
    solid, triangles = ruled(solid), np.empty((0, 3, 3), np.float32)
    for finer in FINER + BESIDE:
        triangles = facets(solid, tolerance / finer, ANGLE / finer)
        is_fine = abs(enclosed(triangles) / volume - 1) < VOLUME_GOAL
        if (is_fine or finer == FINER[-1]) and is_closed(triangles):
            break
    return binary_stl(triangles)


def binary_stl(corners: np.ndarray) -> bytes:
    """Return binary STL of triangles, (n, 3, 3) as float32, in their order."""
    triangles = np.zeros(len(corners), dtype=TRIANGLE)
    triangles["corners"] = corners
    triangles["normal"] = _normals(corners.astype(float))
    return b"mbsd".ljust(80) + len(triangles).to_bytes(4, "little") + triangles.tobytes()


def _normals(corners: np.ndarray) -> np.ndarray:
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(across, axis=1, keepdims=True)
    return across / np.where(length > 0, length, 1.0) + 0.0


def step_bytes(solid: Any, name: str) -> bytes:
    """STEP of a ``cadquery.Solid``, in mm. Its product is called ``name``.

    When it was written is left out.

    Raises UserError if the kernel cannot write its file.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "solid.step"
        solid.exportStep(str(path))
        content = path.read_bytes() if path.exists() else b""
        if not content.rstrip().endswith(b"END-ISO-10303-21;"):
            raise UserError(cut_short(path, content))
    content = _TIMESTAMP.sub(rb"\1'1970-01-01T00:00:00'", content, count=1)
    # the kernel numbers the products of a process
    return _PRODUCT.sub(f"= PRODUCT('{name}','{name}'".encode(), content, count=1)


def read_triangles(stl: bytes) -> np.ndarray:
    """Return (n, 3, 3): the corners (mm) of the triangles of a binary STL, as float64."""
    return np.frombuffer(stl, dtype=TRIANGLE, offset=HEAD)["corners"].astype(float)


def read_mesh(stl: bytes) -> Any:
    """Return the ``trimesh.Trimesh`` of a binary STL, equal corners joined."""
    import io

    import trimesh

    return trimesh.load_mesh(io.BytesIO(stl), file_type="stl")
