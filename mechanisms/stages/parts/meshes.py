"""Meshes of the parts: checks that they are closed, and mass properties."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from shared.contract import Mass
from shared.shapes.facets import SHARP, ruled
from shared.shapes.units import cubic_metres, inertia_metres, metres
from shared.stage.errors import UserError

# Refuses, before a solid is written, anything that could not be printed, weighed or rendered.

VOLUME_TOLERANCE = 5e-3
"""Largest difference between the volume of the mesh and that of the solid, relative."""
OF_ITSELF = (
    "mbsd shaped this part, so this is a fault of the program and not of your model. Use another diameter of pins "
    "(automatic(m, pin=...) in a parts.py, which mbsd new writes), or change a length a little"
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
    """Check a ``trimesh.Trimesh`` (mm) against its solid's volume (mm^3).

    ``automatic``: no author has shaped it.

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


# Mass, centre of mass and inertia of solids: exact from the CAD kernel, times the density of the material.


ENTRIES = ((1, 1), (2, 2), (3, 3), (1, 2), (1, 3), (2, 3))
"""Rows and columns of xx, yy, zz, xy, xz, yz, from 1."""


def mass_of(solid: Any, density: float, along: bool = False, space: bool = False) -> Mass:
    """Return mass properties (kg, m, kg m^2, m^3) of a ``cadquery.Shape`` in mm; ``density`` in kg/m^3.

    The shape is in mm, ``density`` in kg/m^3. The centre of mass is in the body's frame; the inertia is about the axis
    through it, along z. ``along``: with z of the centre of mass and the products of inertia, which count where z is
    that of the model. ``space``: with the whole inertia.
    """
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties, smooth = GProp_GProps(), ruled(solid)
    if smooth is solid:
        BRepGProp.VolumeProperties_s(solid.wrapped, properties)
    else:
        BRepGProp.VolumeProperties_s(smooth.wrapped, properties, SHARP)
    centre = properties.CentreOfMass()
    volume = cubic_metres(properties.Mass())
    matrix = properties.MatrixOfInertia()  # about the centre of mass
    more = {}
    if along:
        products = tuple(-density * inertia_metres(matrix.Value(row, 3)) for row in (1, 2))
        more = {"z": metres(centre.Z()), "products": products}
    if space:
        more["tensor"] = tuple(density * inertia_metres(matrix.Value(row, column)) for row, column in ENTRIES)
    return Mass(
        mass=density * volume,
        com=(metres(centre.X()), metres(centre.Y())),
        inertia=density * inertia_metres(matrix.Value(3, 3)),
        volume=volume,
        **more,
    )


def combined(masses: Iterable[Mass]) -> Mass:
    """Return one body of several pieces: parallel-axis theorem (Steiner) about the common centre of mass."""
    pieces = list(masses)
    mass = sum(piece.mass for piece in pieces)
    if mass == 0:
        return Mass(mass=0.0, com=(0.0, 0.0), inertia=0.0, volume=sum(piece.volume for piece in pieces))
    x = sum(piece.mass * piece.com[0] for piece in pieces) / mass
    y = sum(piece.mass * piece.com[1] for piece in pieces) / mass
    inertia = sum(piece.inertia + piece.mass * ((piece.com[0] - x) ** 2 + (piece.com[1] - y) ** 2) for piece in pieces)
    volume = sum(piece.volume for piece in pieces)
    return Mass(mass=mass, com=(x, y), inertia=inertia, volume=volume, **_along(pieces, mass, (x, y)))


def _along(pieces: list[Mass], mass: float, com: tuple[float, float]) -> dict[str, Any]:
    """Return z of the common centre of mass and products of inertia about it, if all pieces have them."""
    known = [(piece, piece.z, piece.products) for piece in pieces if piece.z is not None and piece.products is not None]
    if len(known) < len(pieces):
        return {}
    z = sum(piece.mass * own for piece, own, _ in known) / mass
    px, py = (
        sum(products[k] + piece.mass * (own - z) * (piece.com[k] - com[k]) for piece, own, products in known)
        for k in (0, 1)
    )
    more: dict[str, Any] = {"z": z, "products": (px, py)}
    if all(piece.tensor is not None for piece in pieces):
        more["tensor"] = _tensor(pieces, np.array([*com, z]))
    return more


def _tensor(pieces: list[Mass], centre: np.ndarray) -> tuple[float, ...]:
    """Return the whole inertia about a common centre of mass (3,), as :class:`Mass` has it (Steiner)."""
    total = np.zeros((3, 3))
    for piece in pieces:
        assert piece.tensor is not None
        assert piece.z is not None
        xx, yy, zz, xy, xz, yz = piece.tensor
        arm = np.array([*piece.com, piece.z]) - centre
        total += np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        total += piece.mass * (float(arm @ arm) * np.eye(3) - np.outer(arm, arm))
    return tuple(float(total[row - 1, column - 1]) for row, column in ENTRIES)
