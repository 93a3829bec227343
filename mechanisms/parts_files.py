"""The bytes of a solid's files: the same for the same solid, whenever and wherever they are made."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any

TOLERANCE = 0.018
"""Largest distance of the mesh from the true surface (mm)."""
ANGLE = 0.3
"""Largest angle between neighbouring facets of a curved face (rad)."""

_TIMESTAMP = re.compile(rb"(FILE_NAME\('[^']*',)'[^']*'")


def stl_bytes(solid: Any) -> bytes:
    """Binary STL of a ``cadquery.Solid``, in mm."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "solid.stl"
        solid.exportStl(str(path), TOLERANCE, ANGLE, ascii=False, relative=False, parallel=False)
        return path.read_bytes()


def step_bytes(solid: Any, name: str) -> bytes:
    """STEP of a ``cadquery.Solid``, in mm, its product called ``name`` and its time of writing left out."""
    from OCP.Interface import Interface_Static

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "solid.step"
        Interface_Static.SetCVal_s("write.step.product.name", name)
        solid.exportStep(str(path))
        return _TIMESTAMP.sub(rb"\1'1970-01-01T00:00:00'", path.read_bytes(), count=1)


def read_mesh(stl: bytes) -> Any:
    """The ``trimesh.Trimesh`` of a binary STL, equal corners joined."""
    import io

    import trimesh

    return trimesh.load_mesh(io.BytesIO(stl), file_type="stl")
