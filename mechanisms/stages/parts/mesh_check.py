"""Refuses, before a solid is written, anything that could not be printed, weighed or rendered."""

from __future__ import annotations

from typing import Any

from shared.stage.errors import UserError

VOLUME_TOLERANCE = 5e-3
"""Largest difference between the volume of the mesh and that of the solid, relative."""


def only_solid(shape: Any, where: str) -> Any:
    """The one valid ``cadquery.Solid`` of a Workplane. Raises UserError naming ``where`` and the remedy."""
    solids = shape.solids().vals()
    if len(solids) != 1:
        raise UserError(
            f"{where} consists of {len(solids)} separate solids, it must be one; give each its own Solid, "
            "or let its features overlap so that they join"
        )
    if not solids[0].isValid():
        raise UserError(
            f"{where} is not a valid solid; look at its last fillet or chamfer: make it smaller, "
            "or round the upright edges first"
        )
    return solids[0]


def check_mesh(mesh: Any, volume: float, through_holes: int, where: str) -> None:
    """Check a ``trimesh.Trimesh`` (mm) against its solid's volume (mm^3).

    Raises UserError, naming ``where``, the number and the remedy, if the mesh is not watertight, is inside out, is
    off in volume by more than :data:`VOLUME_TOLERANCE`, or has another number of through holes than declared.
    """
    if not mesh.is_watertight:
        raise UserError(
            f"{where}: its mesh has {_open_edges(mesh)} open edges, it must be watertight; "
            "avoid cone and sphere tips that end in a point, and features that only touch"
        )
    off = mesh.volume / volume - 1
    if abs(off) > VOLUME_TOLERANCE:
        raise UserError(
            f"{where}: its mesh has {mesh.volume:.1f} mm^3, the solid {volume:.1f} mm^3: {off:+.2%}, allowed "
            f"{VOLUME_TOLERANCE:.1%}; a fillet has probably failed: make it smaller, or apply it earlier"
        )
    expected = 2 - 2 * through_holes
    if mesh.euler_number != expected:
        holes = (2 - mesh.euler_number) / 2
        raise UserError(
            f"{where}: Euler number {mesh.euler_number} means {holes:g} through holes, its Solid declares "
            f"{through_holes} ({expected}); correct through_holes, or look for a hole that is lost or broken"
        )


def _open_edges(mesh: Any) -> int:
    from trimesh.grouping import group_rows

    return len(group_rows(mesh.edges_sorted, require_count=1))
