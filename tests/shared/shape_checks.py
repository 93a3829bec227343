"""Checks of every shape: one valid watertight solid with the right volume and through holes."""

from __future__ import annotations

from typing import Any

import cadquery as cq

from mechanisms.stages.parts.meshes import check_mesh, only_solid
from mechanisms.stages.parts_files import read_mesh, stl_bytes
from shared.shapes.facets import volume_of


def checked(shape: cq.Workplane, through_holes: int) -> tuple[Any, Any]:
    """Return the solid and its mesh, after the checks of the parts stage."""
    solid = only_solid(shape, "shape")
    mesh = read_mesh(stl_bytes(solid))
    check_mesh(mesh, volume_of(solid), through_holes, "shape")
    return solid, mesh
