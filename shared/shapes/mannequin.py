"""Jointed mannequin in side view: limbs with balls in sockets, a torso, a head (mm).

Each function gives the solids of a limb in its own frame: the origin in the proximal joint, x towards the distal one.
The front of thigh and shank is where y is positive; the front of the torso where y is negative. Sizes across are those
of a body 1780 mm high, times ``scale``; they leave the limbs room to bend by 120 degrees at the knee and by 90 at
the hip.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import cadquery as cq
import numpy as np

from shared.shapes.build import turned
from shared.shapes.outline import Point
from shared.shapes.screw import ball
from shared.shapes.solid import Solid, placed

# Rounded limbs: solids along x through elliptical sections, domed ends, and balls of joints (mm).


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


SKIN, JOINT = "beech", "leather"
HIP, KNEE, ANKLE, FIST = 72.0, 46.0, 34.0, 42.0
"""Radii of the balls of the joints, and of a fist."""
ROOM = 11.0
"""Between a ball and its socket."""
LEG, ARM = 88.0, 200.0
"""Middle of a leg and of an arm from that of the body, along z."""
TOLERANCE = 0.4
"""Tolerance of the meshes."""
TORSO: tuple[Section, ...] = (
    (0, 22, 60, 116), (60, 17, 60, 130), (110, 10, 78, 136), (185, 9, 85, 128), (300, 0, 103, 140), (400, 1, 103, 149),
    (468, 8, 82, 140), (503, 8, 58, 104),
)  # fmt: skip
"""Sections of a trunk of 513 mm from hip to shoulder."""
HEAD: tuple[Section, ...] = ((655, -14, 88, 66), (700, -12, 94, 74), (748, -9, 96, 76))
NECK: tuple[Section, ...] = ((488, 6, 50, 54), (550, 2, 46, 48), (650, -2, 46, 46))
NAPE = 7.0
"""Distance beyond the shoulder at which a neck bends (mm)."""
FOOT: tuple[Section, ...] = (
    (-50, -38, 31, 29), (-12, -27, 42, 37), (38, -37, 32, 41), (95, -47, 22, 44), (158, -54, 15, 43),
)  # fmt: skip
"""Sections of a foot of 271 mm whose sole is 69 mm below the ankle."""


def thigh(length: float, scale: float) -> list[Solid]:
    """Return one thigh with the ball of its hip, its socket round the knee."""
    sections = [(40, 2, 56, 54), (90, 1, 60, 62), (140, 0, 58, 63), (250, 4, 54, 58)]
    ends = [(96, 8, 42, 48), (30, 10, 30, 40)]
    shaft = socket(limb(_scaled(sections, scale) + _from_end(ends, length, scale)), length, (KNEE + ROOM) * scale)
    return [_solid("thigh", shaft), _solid("hip_ball", joint_ball(HIP * scale), JOINT)]


def shank(length: float, scale: float) -> list[Solid]:
    """Return one shank with the ball of its knee, its socket round the ankle."""
    sections = [(24, 9, 26, 33), (72, 4, 36, 42), (150, -10, 49, 49), (250, -5, 41, 42)]
    ends = [(88, 0, 29, 31), (14, 0, 25, 28)]
    shaft = socket(limb(_scaled(sections, scale) + _from_end(ends, length, scale)), length, (ANKLE + ROOM) * scale)
    return [_solid("shank", shaft), _solid("knee_ball", joint_ball(KNEE * scale), JOINT)]


def foot(scale: float, height: float) -> list[Solid]:
    """Return one foot with the ball of its ankle, which is ``height`` above the sole."""
    low = height / 69.0
    sections = [(x * scale, y * low, high * low, wide * scale) for x, y, high, wide in FOOT]
    shape = limb(sections, 17 * scale, 44 * scale, power=3.0)
    return [_solid("foot", shape), _solid("ankle_ball", joint_ball(ANKLE * scale), JOINT)]


def torso(length: float, scale: float, nod: float = 0.0) -> list[Solid]:
    """Return trunk, neck and head, with sockets round both hips.

    Head and neck nod by so many degrees, chin to chest.
    """
    along = length / 513.0
    body = limb(
        [(x * along, y * scale, high * scale, wide * scale) for x, y, high, wide in TORSO], 34 * scale, 22 * scale
    )
    for side in (-LEG, LEG):
        body = socket(body, 0.0, (HIP + ROOM) * scale, side * scale)
    beyond = length - 513.0 * scale
    head = limb(_shifted(_scaled(HEAD, scale), beyond), 48 * scale, 87 * scale)
    neck = limb(_shifted(_scaled(NECK, scale), beyond))
    if nod:
        base = (length + NAPE * scale, 0.0, 0.0)
        head, neck = (shape.rotate(base, (*base[:2], 1.0), -nod) for shape in (head, neck))
    return [_solid("torso", body), _solid("head", head), _solid("neck", neck, JOINT)]


def arm(
    upper: float, lower: float, scale: float, shoulder: Point, angles: tuple[float, float], bar: float
) -> list[Solid]:
    """Return one arm from a shoulder at a place of the torso's frame.

    Its parts are at these angles (degrees) in it.

    ``bar``: diameter of the hole through its fist.
    """
    bicep, wrist = [(0, 0, 46, 44), (110, 4, 45, 43)], [(0, 0, 36, 35), (80, -3, 38, 36)]
    upper_arm = limb(_scaled(bicep, scale) + _from_end([(0, 0, 35, 34)], upper, scale), 44 * scale, 33 * scale)
    forearm = limb(_scaled(wrist, scale) + _from_end([(44, 0, 22, 27)], lower, scale), 34 * scale)
    elbow = _moved(shoulder, upper, angles[0])
    hand = _moved(elbow, lower, angles[1])
    fist = _fist(FIST * scale, bar / 2)
    return [
        _solid("upper_arm", placed(upper_arm, *shoulder, turn=angles[0])),
        _solid("forearm", placed(forearm, *elbow, turn=angles[1])),
        Solid("fist", placed(fist, *hand), SKIN, 1, tolerance=TOLERANCE),
    ]


def both_sides(solids: list[Solid], middle: float, away: float) -> list[Solid]:
    """Return each solid on the far and the near side of the body, whose middle is at ``middle``."""
    return [
        replace(solid, name=f"{solid.name}_{side}", shape=placed(solid.shape, z=middle + sign * away))
        for side, sign in (("far", -1.0), ("near", 1.0))
        for solid in solids
    ]


def _solid(name: str, shape: cq.Workplane, material: str = SKIN) -> Solid:
    return Solid(name, shape, material, 0, tolerance=TOLERANCE)


def _scaled(sections: Sequence[Section], scale: float) -> list[Section]:
    return [(x * scale, y * scale, high * scale, wide * scale) for x, y, high, wide in sections]


def _fist(radius: float, hole: float) -> cq.Workplane:
    """Return a barrel round a bar along z."""
    half, edge = 0.95 * radius, 0.82 * radius
    return turned([(hole, -half), (edge, -half), (radius, 0, edge, half), (hole, half)])


def _shifted(sections: Sequence[Section], by: float) -> list[Section]:
    return [(x + by, y, high, wide) for x, y, high, wide in sections]


def _from_end(sections: Sequence[Section], length: float, scale: float) -> list[Section]:
    """Return sections whose x is counted back from the end of a limb."""
    return [(length - x, y, high, wide) for x, y, high, wide in _scaled(sections, scale)]


def _moved(start: Point, length: float, degrees: float) -> Point:
    angle = math.radians(degrees)
    return start[0] + length * math.cos(angle), start[1] + length * math.sin(angle)
