"""Hatches of cut faces: stripes in light and dark of a piece's colour, which lean otherwise than its neighbours'."""

from __future__ import annotations

import zlib
from typing import NamedTuple

from render.film.scene import Colour, Plane, Point

STRIPE = 0.05
"""Width of a light and a dark stripe, as a part of the machine's radius."""
LIGHT = 0.55
"""Part of that which is light."""
MATT = 0.7
"""Roughness of a cut face."""


class Hatch(NamedTuple):
    """Stripes across a ``way``: a point is in the light as long as (point . way / period) mod 1 < LIGHT."""

    way: Point
    period: float
    """In radii of the machine."""


def hatch_of(name: str, plane: Plane) -> Hatch:
    """The hatch of a piece, ``body/piece``, in a plane along z or across it: slope and width follow its name."""
    x, y, z, _ = plane
    kind = zlib.crc32(name.encode()) % 4
    lean = -1.0 if kind % 2 else 1.0
    way = (1.0, lean, 0.0) if z else (-y, x, lean)  # in a face that stands up, along it and z
    return Hatch(way, STRIPE * (1 + kind // 2 / 3))


def light_of(colour: Colour) -> Colour:
    """The light tone of a cut face (linear RGB)."""
    red, green, blue = (0.5 * part + 0.32 for part in colour)
    return red, green, blue


def dark_of(colour: Colour) -> Colour:
    """The dark tone of a cut face (linear RGB)."""
    red, green, blue = (0.3 * part + 0.015 for part in colour)
    return red, green, blue
