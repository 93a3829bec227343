"""Refuses, before a solid is written, anything that could not be printed, weighed or rendered."""

from __future__ import annotations

from typing import Any

import numpy as np

from shared.stage.errors import UserError

VOLUME_TOLERANCE = 5e-3
"""Largest difference between the volume of the mesh and that of the solid, relative."""
OF_ITSELF = (
    "mbsd shaped this part by itself, so this is a fault of the program and not of your model: give the machine pins "
    "of another diameter (automatic(m, pin=...) in a parts.py, which mbsd new writes), or change a length a little"
)
"""The remedy where nobody has written the solid."""


def only_solid(shape: Any, where: str, automatic: bool = False) -> Any:
    """Return the one valid ``cadquery.Solid`` of a Workplane; ``automatic``: no author has shaped it.

    Raises UserError naming ``where`` and the remedy.
    """
    solids = shape.solids().vals()
    if len(solids) != 1:
        raise _wrong(
            f"{where} consists of {len(solids)} separate solids, it must be one",
            "give each its own Solid, or let its features overlap so that they join",
            automatic,
        )
    if not solids[0].isValid():
        raise _wrong(
            f"{where} is not a valid solid",
            "look at its last fillet or chamfer: make it smaller, or round the upright edges first",
            automatic,
        )
    return solids[0]


def check_mesh(mesh: Any, volume: float, through_holes: int, where: str, automatic: bool = False) -> None:
    """Check a ``trimesh.Trimesh`` (mm) against its solid's volume (mm^3); ``automatic``: no author has shaped it.

    Raises UserError, naming ``where``, the number and the remedy, if the mesh is not watertight, is inside out, is
    off in volume by more than :data:`VOLUME_TOLERANCE`, or has another number of through holes than declared.
    """
    if not mesh.is_watertight:
        raise _wrong(
            f"{where}: its mesh {_edges(mesh)}, it must be watertight",
            "avoid cone and sphere tips that end in a point, and features that only touch",
            automatic,
        )
    off = mesh.volume / volume - 1
    if abs(off) > VOLUME_TOLERANCE:
        raise _wrong(
            f"{where}: its mesh has {mesh.volume:.1f} mm^3, the solid {volume:.1f} mm^3: {off:+.2%}, allowed "
            f"{VOLUME_TOLERANCE:.1%}",
            "a fillet has probably failed: make it smaller, or apply it earlier",
            automatic,
        )
    expected = 2 - 2 * through_holes
    if mesh.euler_number != expected:
        holes = (2 - mesh.euler_number) / 2
        raise _wrong(
            f"{where}: Euler number {mesh.euler_number} means {holes:g} through holes, its Solid declares "
            f"{through_holes} ({expected})",
            "correct through_holes, or look for a hole that is lost or broken",
            automatic,
        )


def _wrong(fault: str, remedy: str, automatic: bool) -> UserError:
    return UserError(f"{fault}; {OF_ITSELF if automatic else remedy}")


def _edges(mesh: Any) -> str:
    """Return words for the edges that do not belong to exactly two triangles."""
    counts = np.unique(mesh.edges_sorted, axis=0, return_counts=True)[1]
    numbers = {"open edges": (counts == 1).sum(), "edges at which more than two faces meet": (counts > 2).sum()}
    return "has " + " and ".join(f"{number} {words}" for words, number in numbers.items() if number)
