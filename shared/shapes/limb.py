"""Rounded limbs: solids along x through elliptical sections, domed ends, and balls of joints (mm)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import cadquery as cq
import numpy as np

from shared.shapes.build import turned
from shared.shapes.stud import ball

type Section = tuple[float, float, float, float]
"""Section of a limb: x, y of its middle, half its height along y, half its width along z."""

AROUND, STATIONS = 24, 9
"""Corners of a section, sections from one end of a limb to the other. Neighbouring facets turn by less than what a
picture shows as an edge, so that limbs look round; a mesh of a truly round one has ten times the triangles."""
DOME = (18.0, 36.0, 53.0, 68.0, 80.0)
"""Degrees at which the sections of a domed end stand."""
BALL, LAST = 10, 82.0
"""Strips of a ball, and degrees of its last section."""


def limb(sections: Sequence[Section], start: float = 0.0, end: float = 0.0, power: float = 2.0) -> cq.Workplane:
    """Return a solid through two or more sections in rising order of x.

    ``start`` and ``end`` are the heights of its domed ends.

    An end of 0 is flat. Sections are ellipses; with a larger ``power`` they are squarer (Lame's curves). No through
    hole. Raises ValueError where sections do not follow each other.
    """
    if len(sections) < 2 or any(b[0] <= a[0] for a, b in pairwise(sections)):
        raise ValueError("a limb needs two or more sections at rising x")
    rings = [*_dome(sections[0], -start)[::-1], *_between(sections), *_dome(sections[-1], end)]
    return cq.Workplane(obj=cq.Solid.makeLoft([_ring(section, power) for section in rings], True))


def joint_ball(radius: float) -> cq.Workplane:
    """Return a ball about the origin of straight strips within ``radius``, its small flats on the x axis."""
    angles = [math.radians(-LAST + 2 * LAST * k / BALL) for k in range(BALL + 1)]
    profile = [(radius * math.cos(a), radius * math.sin(a)) for a in angles]
    return turned([(0.0, profile[0][1]), *profile, (0.0, profile[-1][1])]).rotate((0, 0, 0), (0, 1, 0), 90)


def socket(shape: cq.Workplane, x: float, radius: float, z: float = 0.0) -> cq.Workplane:
    """Return the shape without a ball about (x, 0, z), in which the ball of another limb turns."""
    return shape.cut(ball(radius).rotate((0, 0, 0), (0, 1, 0), 90).translate((x, 0.0, z)))


def _between(sections: Sequence[Section]) -> list[Section]:
    """Return sections at even steps, by the monotone cubics of Fritsch and Carlson.

    They never swing beyond the given sections.
    """
    given = np.array(sections, dtype=float)
    x, rest = given[:, 0], given[:, 1:]
    wide = np.diff(x)[:, None]
    rise = np.diff(rest, axis=0) / wide
    slope = np.vstack([rise[:1], np.zeros_like(rest[2:]), rise[-1:]])
    before, after = rise[:-1], rise[1:]
    both = before * after > 0
    weights = 2 * wide[1:] + wide[:-1], wide[1:] + 2 * wide[:-1]
    slope[1:-1][both] = (
        sum(weights) / (weights[0] / np.where(both, before, 1.0) + weights[1] / np.where(both, after, 1.0))
    )[both]
    at = np.linspace(x[0], x[-1], STATIONS)
    k = np.clip(np.searchsorted(x, at, "right") - 1, 0, len(x) - 2)
    h, u = wide[k], ((at - x[k]) / wide[k, 0])[:, None]
    values = (
        rest[k] * (1 + 2 * u) * (1 - u) ** 2
        + rest[k + 1] * u**2 * (3 - 2 * u)
        + h * slope[k] * u * (1 - u) ** 2
        - h * slope[k + 1] * u**2 * (1 - u)
    )
    return [
        (float(place), float(y), float(high), float(wide)) for place, (y, high, wide) in zip(at, values, strict=True)
    ]


def _dome(section: Section, bulge: float) -> list[Section]:
    """Return sections beyond an end, of a quarter of an ellipse, outwards."""
    if bulge == 0:
        return []
    x, y, high, wide = section
    angles = [math.radians(degrees) for degrees in DOME]
    return [(x + bulge * math.sin(a), y, high * math.cos(a), wide * math.cos(a)) for a in angles]


def _ring(section: Section, power: float) -> cq.Wire:
    """Return a section as a polygon with corners at even angles."""
    x, y, high, wide = section
    corners = []
    for k in range(AROUND):
        c, s = math.cos(2 * math.pi * k / AROUND), math.sin(2 * math.pi * k / AROUND)
        r = (abs(c) ** power + abs(s) ** power) ** (-1 / power)
        corners.append(cq.Vector(x, y + high * r * c, wide * r * s))
    return cq.Wire.makePolygon(corners, close=True)
