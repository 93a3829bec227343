"""Leg on a bicycle in side view: outlines of thigh, calf, foot, chainring and saddle (mm).

The rider faces right.

The thigh lies along x from hip to knee with its front up; the shank along x from the pedal's axle to the knee with the
calf up, the ankle stiff.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

import cadquery as cq
import numpy as np

from shared.shapes.build import eased, extruded
from shared.shapes.outline import Point, circle, hull
from shared.shapes.solid import Solid, placed

THIGH = (
    (-78, 18), (-40, 74), (60, 84), (180, 79), (300, 65), (375, 53), (422, 36), (442, 2), (428, -34), (375, -47),
    (280, -60), (170, -78), (80, -96), (0, -104), (-62, -78), (-88, -28),
)  # fmt: skip
"""Outline of a thigh of 400 mm."""
CALF = (
    (-36, 2), (-26, -40), (18, -54), (85, -44), (180, -38), (290, -32), (370, -34), (418, -30), (440, 2), (422, 34),
    (370, 36), (300, 48), (215, 70), (140, 78), (75, 68), (20, 48), (-22, 36),
)  # fmt: skip
"""Outline from the knee at the origin to the ankle at (405, 0), its muscle up."""
FOOT = (
    (-34, 0), (-22, -36), (8, -70), (22, -96), (44, -98), (58, -70), (76, -24), (104, 22), (134, 58), (142, 104),
    (120, 146), (84, 178), (52, 190), (32, 178), (26, 130), (16, 70), (-4, 40), (-24, 26),
)  # fmt: skip
"""With a shoe, on the pedal at the origin."""
ANKLE = (110.0, 112.0)
"""Ankle of the foot."""
TOOTH = ((-0.32, 0.0), (-0.12, 1.0), (0.12, 1.0), (0.32, 0.0))
"""Corners of a tooth: pitches, and heights."""
RING = (95.0, 44, 5, 36.0)
"""Radius, teeth, arms and hub of the chainring."""
LEVEL = math.radians(22.0)
"""The foot is level where the shank leans forward by this."""
SADDLE = ((-98.0, 6.0, 34.0), (20.0, -8.0, 18.0), (118.0, 4.0, 10.0))
"""Round these circles (x, y, radius)."""


def smooth(points: Sequence[Point], scale: float = 1.0) -> cq.Wire:
    """Return a closed curve of tangent arcs through points: two between each and the next (biarcs).

    All directions are met.
    """
    at = scale * np.array(points, dtype=float)
    ways = np.roll(at, -1, axis=0) - at
    lengths = np.linalg.norm(ways, axis=1)[:, None]
    units = ways / lengths
    before, shorter = np.roll(units, 1, axis=0), np.roll(lengths, 1, axis=0)
    tangents = before * lengths + units * shorter  # the nearer neighbour counts more
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    edges: list[cq.Edge] = []
    for k, (first, way) in enumerate(zip(at, ways, strict=True)):
        next_one = (k + 1) % len(at)
        edges += _biarc(first, tangents[k], way, at[next_one], tangents[next_one])
    return cq.Wire.assembleEdges(edges)


def _biarc(a: np.ndarray, u: np.ndarray, way: np.ndarray, b: np.ndarray, v: np.ndarray) -> list[cq.Edge]:
    """Return two arcs from a, leaving along u, to b, arriving along v, with equal tangent lengths."""
    bend, along = 2 * (1 - float(u @ v)), float(way @ (u + v))
    square = float(way @ way)
    reach = square / (2 * along) if bend < 1e-9 else (math.sqrt(along**2 + bend * square) - along) / bend
    middle = (a + reach * u + b - reach * v) / 2
    first = cq.Edge.makeTangentArc(cq.Vector(*a, 0), cq.Vector(*u, 0), cq.Vector(*middle, 0))
    second = cq.Edge.makeTangentArc(cq.Vector(*b, 0), cq.Vector(*-v, 0), cq.Vector(*middle, 0))
    return [first, second]


def thigh(length: float) -> cq.Wire:
    """Return the outline from the hip at the origin to the knee at (length, 0)."""
    return smooth(THIGH, length / 400)


def calf(length: float) -> cq.Wire:
    """Return the outline from the knee at (length, 0) to the ankle."""
    scale = length / 440
    x, y = _turned(ANKLE, LEVEL)
    along = np.array([x - 440, y]) / math.hypot(x - 440, y)
    across = np.array([along[1], -along[0]])
    points = [np.array([440, 0]) + u * along + v * across for u, v in CALF]
    return smooth([(float(u), float(v)) for u, v in points], scale)


def foot(length: float) -> cq.Wire:
    """Return the outline of a foot on the pedal at the origin, of a shank of this length."""
    return smooth([_turned(point, LEVEL) for point in FOOT], length / 440)


def _turned(point: Point, angle: float) -> Point:
    c, s = math.cos(angle), math.sin(angle)
    return c * point[0] - s * point[1], s * point[0] + c * point[1]


def chainring(radius: float, teeth: int, arms: int, eye: float) -> tuple[cq.Wire, list[cq.Wire]]:
    """Return a toothed wheel about the origin, and the windows between its arms.

    ``eye`` is the radius of its hub.
    """
    depth, pitch = 0.06 * radius, 2 * math.pi / teeth
    corners = [((k + part) * pitch, radius - depth * (1 - up)) for k in range(teeth) for part, up in TOOTH]
    rim = cq.Wire.makePolygon([cq.Vector(r * math.cos(a), r * math.sin(a), 0) for a, r in corners], close=True)
    middle, room = (eye + 0.84 * radius) / 2, (0.84 * radius - eye) / 2
    width = math.pi * middle / arms - 0.11 * radius
    windows = []
    for k in range(arms):
        angle = 2 * math.pi * (k + 0.5) / arms
        windows.append(_slot(middle, angle, min(room, width), width))
    return rim, windows


def _slot(middle: float, angle: float, radius: float, half: float) -> cq.Wire:
    """Return a window along the arc of radius ``middle``, or a hole if it is no longer than wide."""
    if half - radius < 1.0:
        return circle(middle * math.cos(angle), middle * math.sin(angle), radius)
    turn = (half - radius) / middle
    low, high = middle - radius, middle + radius

    def polar(r: float, a: float) -> cq.Vector:
        return cq.Vector(r * math.cos(a), r * math.sin(a), 0)

    def end(a: float, outward: float) -> cq.Vector:
        return polar(middle, a) + cq.Vector(-math.sin(a), math.cos(a), 0) * (outward * radius)

    first, last = angle - turn, angle + turn
    return cq.Wire.assembleEdges(
        [
            cq.Edge.makeThreePointArc(polar(high, first), polar(high, angle), polar(high, last)),
            cq.Edge.makeThreePointArc(polar(high, last), end(last, 1.0), polar(low, last)),
            cq.Edge.makeThreePointArc(polar(low, last), polar(low, angle), polar(low, first)),
            cq.Edge.makeThreePointArc(polar(low, first), end(first, -1.0), polar(high, first)),
        ]
    )


def seat(hip: Point, z: float = 0.05) -> list[Solid]:
    """Return seat tube and saddle, flat on a base plate, between the bracket at the origin and the hip."""
    x, y = hip
    far = math.hypot(x, y)
    near = min(0.12 * far, 80.0), max(far - 150.0, 0.5 * far)
    ends = [(x / far * part, y / far * part, 15.0) for part in near]
    tube = eased(extruded(hull(ends), 8.0, z), 1.5, ">Z")
    top = eased(extruded(hull([(x + 38.0 + u, y - 138.0 + v, r) for u, v, r in SADDLE]), 11.0, z + 8.05), 2.0, ">Z")
    return [Solid("seat_tube", tube, "aluminium_red", 0), Solid("saddle", top, "leather", 0)]


class Shaped(Protocol):
    """Automatic parts, which take outlines and materials for their bodies."""

    def join(
        self, body: str, outline: cq.Wire, at: Point = ..., holes: Sequence[cq.Wire] = ..., sharp: bool = ...
    ) -> None:
        """Join an outline to a body's plate."""
        ...

    def material(self, body: str, name: str) -> None:
        """Set the material of a body's plate."""
        ...


def dress(made: Shaped, thigh_length: float, shank_length: float, pen: Point) -> None:
    """Add the outlines of bodies "thigh", "shank" and "crank".

    ``pen`` is a place of the shank that carries a stylus.
    """
    made.join("thigh", thigh(thigh_length))
    made.join("shank", calf(shank_length), at=(shank_length, 0.0))
    made.join("shank", foot(shank_length))
    made.join("shank", circle(*pen, 20.0), at=pen)
    ring, windows = chainring(*RING)
    made.join("crank", ring, holes=windows, sharp=True)
    for body, material in (("thigh", "beech"), ("shank", "beech"), ("crank", "aluminium")):
        made.material(body, material)


# Bicycle and ergometer in side view, flat on a base plate (mm).
#
# The bracket is the origin, the rider faces right.
#
# Sizes are those of a road bicycle for a rider of 1.75 m; the saddle is that of leg.py.


WHEEL = (335.0, 24.0, 14.0, 20.0)
"""Radius of a tyre, its height, that of the rim, and the radius of the hub."""
SPOKES = 12
REAR, FRONT = (-405.0, 70.0), (592.0, 70.0)
"""Axles."""
HEAD = ((372.0, 545.0), (404.0, 452.0))
"""Upper and lower end of the head tube."""
BAR = ((362.0, 586.0), (404.0, 606.0), (462.0, 590.0), (478.0, 540.0), (446.0, 508.0))
"""Stem and handlebar."""
TUBE, STAY = 17.0, 9.0
"""Half the widths of tubes and of stays."""
SHELL = 82.0
"""Radius of the ring round what bears the crank on the base."""
SEAT = 0.80
"""Place where the top tube meets the seat tube, as a part of the way from bracket to hip."""
FLYWHEEL = ((430.0, -40.0), 215.0)
"""Axle of an ergometer's wheel, and its radius."""
FEET = ((-300.0, -312.0), (664.0, -312.0))
"""Places on which an ergometer stands."""


def wheel(name: str, at: Point, low: float, thick: float) -> list[Solid]:
    """Return the tyre, and the rim with spokes."""
    radius, tall, rim, hub = WHEEL
    inner = radius - tall
    tyre = eased(extruded(circle(*at, radius), thick, low, [circle(*at, inner)]), 0.3 * thick, ">Z")
    ring = extruded(circle(*at, inner - 0.05), thick - 1.0, low, [circle(*at, inner - rim)])
    for k in range(SPOKES):
        spoke = cq.Workplane().box(inner - 0.5 * rim, 3.0, 0.6 * thick, centered=(False, True, False))
        ring = ring.union(placed(spoke, *at, low, 360.0 / SPOKES * k))
    ring = ring.union(extruded(circle(*at, hub), thick - 1.0, low))
    return [Solid(f"tyre_{name}", tyre, "rubber", 1), Solid(f"wheel_{name}", ring, "aluminium", SPOKES)]


def frame(hip: Point, low: float, thick: float) -> Solid:
    """Return tubes, fork and handlebar of a bicycle whose saddle is under a hip."""
    top = (SEAT * hip[0], SEAT * hip[1])
    head, lower = HEAD
    tubes = [
        *((a, b, TUBE) for a, b in (((0.0, 0.0), top), (top, head), ((0.0, 0.0), lower), (head, lower))),
        *((a, b, STAY) for a, b in (((0.0, 0.0), REAR), (top, REAR), (lower, FRONT))),
        *((a, b, 0.7 * TUBE) for a, b in zip([head, *BAR[:-1]], BAR, strict=True)),
    ]
    shape = _tubes(tubes, low, thick).union(extruded(circle(0, 0, SHELL), thick, low))
    return Solid("frame", shape.cut(extruded(circle(0, 0, SHELL - TUBE), thick, low)), "aluminium_red", 3)


def ergometer(hip: Point, low: float, thick: float) -> list[Solid]:
    """Return a flywheel on a frame that stands on the floor, with a handlebar."""
    (x, y), radius = FLYWHEEL
    floor = FEET[0][1] + TUBE
    top, head = (0.74 * hip[0], 0.74 * hip[1]), (360.0, 470.0)
    tubes = [
        ((0.0, 0.0), top, TUBE),
        ((0.0, 0.0), (x, y), TUBE),
        ((x, y), head, TUBE),
        ((-0.35 * SHELL, 0.0), (-120.0, floor), TUBE),
        ((x, y), (x, floor), TUBE),
        ((FEET[0][0] + TUBE, floor), (FEET[1][0] - TUBE, floor), TUBE),
        *((a, b, 0.7 * TUBE) for a, b in zip([head, *BAR[:-1]], BAR, strict=True)),
    ]
    shape = _tubes(tubes, low, thick).union(extruded(circle(0, 0, SHELL), thick, low))
    shape = shape.cut(extruded(circle(0, 0, SHELL - TUBE), thick, low))
    disc = extruded(circle(x, y, radius), thick, low + thick + 0.05)
    for k in range(5):
        turn = 2 * math.pi * k / 5
        window = circle(x + 0.52 * radius * math.cos(turn), y + 0.52 * radius * math.sin(turn), 0.22 * radius)
        disc = disc.cut(extruded(window, 2 * thick, low + thick - 1.0))
    return [Solid("frame", shape, "aluminium_red", 2), Solid("flywheel", eased(disc, 1.5, ">Z"), "cast_iron", 5)]


def _tubes(tubes: Sequence[tuple[Point, Point, float]], low: float, thick: float) -> cq.Workplane:
    """Return straight tubes with round ends, as one plate."""
    shapes = [extruded(hull([(*a, half), (*b, half)]), thick, low) for a, b, half in tubes]
    whole = shapes[0]
    for shape in shapes[1:]:
        whole = whole.union(shape)
    return whole
