"""Pieces and parts for the tests of clearance."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.stage import check
from shared.contract import BodyParts, Mass, Motion, Parts, Provenance
from shared.contract.clearance import Clearance
from tools.models.motions import four_bar_motion

NO_MASS = Mass(mass=0.0, com=(0.0, 0.0), inertia=0.0, volume=0.0)


def prism(body: str, name: str, corners: list[tuple[float, float]], z0: float, z1: float) -> MeshPiece:
    """A prism on a convex outline (counter-clockwise, mm)."""
    low = [(x, y, z0) for x, y in corners]
    high = [(x, y, z1) for x, y in corners]
    n = len(corners)
    faces = [(low[0], low[i + 1], low[i]) for i in range(1, n - 1)]
    faces += [(high[0], high[i], high[i + 1]) for i in range(1, n - 1)]
    for i in range(n):
        j = (i + 1) % n
        faces += [(low[i], low[j], high[j]), (low[i], high[j], high[i])]
    return MeshPiece(body, name, np.array(faces))


def box(body: str, name: str, x: float, y: float, z: float, size: tuple[float, float, float]) -> MeshPiece:
    """A box with its middle at (x, y) and its underside at z."""
    a, b, h = size[0] / 2, size[1] / 2, size[2]
    return prism(body, name, [(x - a, y - b), (x + a, y - b), (x + a, y + b), (x - a, y + b)], z, z + h)


def disc(body: str, name: str, x: float, y: float, radius: float, z0: float, z1: float, sides: int = 64) -> MeshPiece:
    angles = [2 * math.pi * i / sides for i in range(sides)]
    return prism(body, name, [(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles], z0, z1)


def four_bar_pieces() -> list[MeshPiece]:
    """Bars 16 mm wide on three layers, the pin of joint C 0.5 mm clear of nothing in particular."""
    return [
        box("ground", "base", 60.0, 0.0, -12.0, (220.0, 80.0, 12.0)),
        disc("ground", "post_D", 120.0, 0.0, 8.0, 0.0, 25.0),
        box("crank", "crank", 20.0, 0.0, 5.0, (56.0, 16.0, 6.0)),
        disc("crank", "pin_B", 40.0, 0.0, 4.0, 6.0, 14.5),
        box("coupler", "coupler", 60.0, 0.0, 15.0, (136.0, 16.0, 6.0)),
        box("rocker", "rocker", 45.0, 0.0, 25.5, (106.0, 16.0, 6.0)),
    ]


def parts_of(pieces: list[MeshPiece]) -> Parts:
    return Parts(
        mechanism="four_bar",
        provenance=Provenance(inputs="0" * 64, versions={}),
        bodies={piece.body: BodyParts(pieces={}, mass=NO_MASS, z=0.0) for piece in pieces},
    )


def checked(pieces: list[MeshPiece], motion: Motion | None = None) -> Clearance:
    return check(parts_of(pieces), motion or four_bar_motion(), pieces, "key")


def lifted(pieces: list[MeshPiece], body: str, by: float) -> list[MeshPiece]:
    return [
        replace(piece, triangles=piece.triangles + np.array([0.0, 0.0, by])) if piece.body == body else piece
        for piece in pieces
    ]
