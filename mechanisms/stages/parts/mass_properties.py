"""Mass, centre of mass and inertia of solids: exact from the CAD kernel, times the density of the material."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from shared.contract import Mass
from shared.shapes.facets import SHARP, ruled
from shared.shapes.units import cubic_metres, inertia_metres, metres


def mass_of(solid: Any, density: float, along: bool = False) -> Mass:
    """Mass properties (kg, m, kg m^2, m^3) of a ``cadquery.Shape`` in mm, with ``density`` in kg/m^3.

    The centre of mass is in the body's frame; the inertia is about the axis through it, along z. ``along``: with z of
    the centre of mass and the products of inertia, which count where z is that of the model.
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
    return Mass(
        mass=density * volume,
        com=(metres(centre.X()), metres(centre.Y())),
        inertia=density * inertia_metres(matrix.Value(3, 3)),
        volume=volume,
        **more,
    )


def combined(masses: Iterable[Mass]) -> Mass:
    """One body of several pieces: parallel-axis theorem (Steiner) about the common centre of mass."""
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
    """z of the common centre of mass and the products of inertia about it, where all pieces have them."""
    known = [(piece, piece.z, piece.products) for piece in pieces if piece.z is not None and piece.products is not None]
    if len(known) < len(pieces):
        return {}
    z = sum(piece.mass * own for piece, own, _ in known) / mass
    px, py = (
        sum(products[k] + piece.mass * (own - z) * (piece.com[k] - com[k]) for piece, own, products in known)
        for k in (0, 1)
    )
    return {"z": z, "products": (px, py)}
