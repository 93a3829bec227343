"""Triangles of a solid's mesh, read from the kernel at once.

One by one they take longer than the mesh.
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from shared.stage.errors import UserError

HEAD = 84
"""Bytes of a binary STL before its triangles; the last four are their number."""
TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
SHARP = 1e-3
"""Relative error asked of volume and inertia of solids with extruded splines: it comes out below 1e-6 (of a cam 6e-9),
and asking for 1e-6 takes eighty times as long."""


def facets(shape: Any, tolerance: float, angle: float, relative: bool = False) -> np.ndarray:
    """Return the triangles of a ``cadquery.Shape``, (n, 3, 3) float32: their corners (mm).

    Corners are counter-clockwise seen from outside, in an order of their own. Triangles are ``tolerance`` from the
    surface at most (mm, or ``relative`` to the length of each edge), with ``angle`` (rad) between neighbours. The shape
    carries no mesh along afterwards.

    Raises UserError where there is no room for the kernel's file.
    """
    from OCP.BRepTools import BRepTools

    BRepTools.Clean_s(shape.wrapped)  # a mesh that is there already would be kept
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "solid.stl"
        shape.exportStl(str(path), tolerance, angle, ascii=False, relative=relative, parallel=False)
        content = path.read_bytes() if path.exists() else b""
        BRepTools.Clean_s(shape.wrapped)
        if len(content) < HEAD or len(content) != HEAD + TRIANGLE.itemsize * int.from_bytes(content[80:HEAD], "little"):
            raise UserError(cut_short(path, content))
        return _with_three_corners(_ordered(np.frombuffer(content, dtype=TRIANGLE, offset=HEAD)["corners"]))


def is_closed(corners: np.ndarray) -> bool:
    """Return True if triangles (n, 3, 3) are closed: each edge belongs to two, in opposite directions."""
    places = np.ascontiguousarray(corners, np.float32).reshape(-1, 3)
    _, numbers = np.unique(places.view(np.dtype((np.void, 12))).ravel(), return_inverse=True)
    first = numbers.reshape(-1, 3).astype(np.int64)
    second = np.roll(first, -1, axis=1)
    edges, back = (np.sort((a * len(places) + b).ravel()) for a, b in ((first, second), (second, first)))
    return bool((edges == back).all() and (edges[1:] != edges[:-1]).all())


def enclosed(corners: np.ndarray) -> float:
    """Return the volume (mm^3) that closed triangles (n, 3, 3) enclose."""
    corners = corners.astype(float)
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6


def ruled(solid: Any) -> Any:
    """Return the solid with its extruded curves as B-spline surfaces, which are the same surfaces.

    The kernel divides the height of an extruded spline as finely as the curve and makes a hundred times the triangles,
    whose corners stand out from the chords of the wall's edges; of a B-spline surface it knows the straight direction.
    """
    if all(face.geomType() != "EXTRUSION" for face in solid.Faces()):
        return solid
    from OCP.ShapeCustom import ShapeCustom

    return type(solid)(ShapeCustom.ConvertToBSpline_s(solid.wrapped, True, False, False, False))


def volume_of(solid: Any) -> float:
    """Return the volume (mm^3) of a ``cadquery.Shape``.

    The kernel's own is percents off along large extruded splines.
    """
    smooth = ruled(solid)
    return solid.Volume() if smooth is solid else smooth.Volume(SHARP)


def _with_three_corners(corners: np.ndarray) -> np.ndarray:
    """Return the triangles of (n, 3, 3) that have three corners.

    An edge shorter than float32 can tell has one end in the file; a triangle on it would be an open edge.
    """
    equal = (corners == np.roll(corners, -1, axis=1)).all(axis=2)
    return corners[~equal.any(axis=1)]


def _ordered(corners: np.ndarray) -> np.ndarray:
    """Return the triangles sorted, the lowest corner of each first.

    The kernel gives the same ones each time, but those of a face with many holes in another order.
    """
    corners = corners + np.float32(0)  # -0 becomes 0
    lowest = np.where(_before(corners[:, 1], corners[:, 0]), 1, 0)
    lowest = np.where(_before(corners[:, 2], corners[np.arange(len(corners)), lowest]), 2, lowest)
    turn = (lowest[:, None] + np.arange(3)) % 3  # same winding
    corners = np.take_along_axis(corners, turn[:, :, None], axis=1)
    return corners[np.lexsort(corners.reshape(-1, 9).T[::-1])]


def _before(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return True, (n,), where points p (n, 3) come before q: by x, then y, then z."""
    (px, py, pz), (qx, qy, qz) = p.T, q.T
    return (px < qx) | ((px == qx) & ((py < qy) | ((py == qy) & (pz < qz))))


def cut_short(path: Path, content: bytes) -> str:
    """Return an error for a file that the CAD kernel cut short.

    The kernel reports no error when a disk is full.
    """
    free = shutil.disk_usage(path.parent).free / 1e6
    return (
        f"the CAD kernel wrote {len(content)} bytes of {path.name} and no more; {free:.1f} MB are free at "
        f"{path.parent.parent}: free some disk space or set TMPDIR to another folder"
    )
