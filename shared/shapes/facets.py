"""The triangles of a solid's mesh, out of the kernel at once: asked for one by one they take longer than the mesh."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from shared.stage.errors import UserError

if TYPE_CHECKING:
    import cadquery as cq

HEAD = 84
"""Bytes of a binary STL before its triangles; the last four are their number."""
TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def facets(shape: cq.Shape, tolerance: float, angle: float) -> np.ndarray:
    """(n, 3, 3) float32: corners (mm) of triangles that are ``tolerance`` (mm) from the surface at most, with ``angle``
    (rad) between neighbours; counter-clockwise seen from outside. The shape carries no mesh along afterwards.

    Raises UserError where there is no room for the kernel's file.
    """
    from OCP.BRepTools import BRepTools

    BRepTools.Clean_s(shape.wrapped)  # a mesh that is there already would be kept
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "solid.stl"
        shape.exportStl(str(path), tolerance, angle, ascii=False, relative=False, parallel=False)
        content = path.read_bytes() if path.exists() else b""
        BRepTools.Clean_s(shape.wrapped)
        if len(content) < HEAD or len(content) != HEAD + TRIANGLE.itemsize * int.from_bytes(content[80:HEAD], "little"):
            raise UserError(cut_short(path, content))
        return np.frombuffer(content, dtype=TRIANGLE, offset=HEAD)["corners"].copy()


def cut_short(path: Path, content: bytes) -> str:
    """Words for a file that the CAD kernel cut short; it reports no error when a disk is full."""
    free = shutil.disk_usage(path.parent).free / 1e6
    return (
        f"the CAD kernel wrote {len(content)} bytes of {path.name} and no more; {free:.1f} MB are free at "
        f"{path.parent.parent}: free some disk space or set TMPDIR to another folder"
    )
