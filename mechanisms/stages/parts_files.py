"""Makes the bytes of a solid's files: equal solids give equal bytes, whenever and wherever they are made."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from shared.shapes.facets import HEAD, TRIANGLE, cut_short, facets
from shared.stage.errors import UserError

TOLERANCE = 0.018
"""Largest distance of the mesh from the true surface (mm), where a solid does not say otherwise."""
ANGLE = 0.3
"""Largest angle between neighbouring facets of a curved face (rad)."""
SHARP = 1e-3
"""Relative error asked of volume and inertia of solids with extruded splines: it comes out below 1e-6 (of a cam 6e-9),
and asking for 1e-6 takes eighty times as long."""
VOLUME_GOAL = 4.5e-3
"""Relative difference to the solid's volume at which a mesh is fine enough."""

_PRODUCT = re.compile(rb"= PRODUCT\('[^']*',\s*'[^']*'")
_TIMESTAMP = re.compile(rb"(FILE_NAME\('[^']*',)'[^']*'")


def stl_bytes(solid: Any, tolerance: float | None = None) -> bytes:
    """Binary STL of a ``cadquery.Solid``, in mm, its triangles in an order of their own.

    ``tolerance`` (mm) is :data:`TOLERANCE` by default. Small parts get a finer mesh until it holds their
    volume to :data:`VOLUME_GOAL`. Raises UserError if the kernel cannot write its file.
    """
    volume, tolerance = volume_of(solid), tolerance or TOLERANCE
    solid = ruled(solid)
    for finer in (1, 2, 4):
        triangles = facets(solid, tolerance / finer, ANGLE / finer)
        if abs(_volume(triangles.astype(float)) / volume - 1) < VOLUME_GOAL:
            break
    return binary_stl(_with_three_corners(triangles))


def binary_stl(corners: np.ndarray) -> bytes:
    """Binary STL of triangles, (n, 3, 3) as float32, in their order."""
    triangles = np.zeros(len(corners), dtype=TRIANGLE)
    triangles["corners"] = corners
    triangles["normal"] = _normals(corners.astype(float))
    return b"mbsd".ljust(80) + len(triangles).to_bytes(4, "little") + triangles.tobytes()


def _with_three_corners(corners: np.ndarray) -> np.ndarray:
    """Those of the triangles (n, 3, 3) that have three corners.

    An edge shorter than float32 can tell has one end in the file; a triangle on it would be an open edge.
    """
    equal = (corners == np.roll(corners, -1, axis=1)).all(axis=2)
    return corners[~equal.any(axis=1)]


def ruled(solid: Any) -> Any:
    """The solid with its extruded curves as B-spline surfaces, which are the same surfaces.

    The kernel divides the height of an extruded spline as finely as the curve and makes a hundred times the triangles,
    whose corners stand out from the chords of the wall's edges; of a B-spline surface it knows the straight direction.
    """
    if all(face.geomType() != "EXTRUSION" for face in solid.Faces()):
        return solid
    from OCP.ShapeCustom import ShapeCustom

    return type(solid)(ShapeCustom.ConvertToBSpline_s(solid.wrapped, True, False, False, False))


def volume_of(solid: Any) -> float:
    """The volume (mm^3) of a ``cadquery.Shape``; the kernel's own is percents off along large extruded splines."""
    smooth = ruled(solid)
    return solid.Volume() if smooth is solid else smooth.Volume(SHARP)


def _volume(corners: np.ndarray) -> float:
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6


def _normals(corners: np.ndarray) -> np.ndarray:
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(across, axis=1, keepdims=True)
    return across / np.where(length > 0, length, 1.0) + 0.0


def step_bytes(solid: Any, name: str) -> bytes:
    """STEP of a ``cadquery.Solid``, in mm. Its product is called ``name``; when it was written is left out.

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
    """(n, 3, 3): the corners (mm) of the triangles of a binary STL, as float64."""
    return np.frombuffer(stl, dtype=TRIANGLE, offset=HEAD)["corners"].astype(float)


def read_mesh(stl: bytes) -> Any:
    """The ``trimesh.Trimesh`` of a binary STL, equal corners joined."""
    import io

    import trimesh

    return trimesh.load_mesh(io.BytesIO(stl), file_type="stl")
