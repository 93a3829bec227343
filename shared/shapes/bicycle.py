"""Bicycle and ergometer in side view, flat on a base plate (mm).

The bracket is the origin, the rider faces right.

Sizes are those of a road bicycle for a rider of 1.75 m; the saddle is that of leg.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import cadquery as cq

from shared.shapes.build import eased, extruded
from shared.shapes.outline import Point, circle, hull
from shared.shapes.solid import Solid, placed

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
"""Where the top tube meets the seat tube, as a part of the way from bracket to hip."""
FLYWHEEL = ((430.0, -40.0), 215.0)
"""Axle of an ergometer's wheel, and its radius."""
FEET = ((-300.0, -312.0), (664.0, -312.0))
"""Where an ergometer stands."""


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
    return [
        Solid("frame", shape, "aluminium_red", 2),
        Solid("flywheel", eased(disc, 1.5, ">Z"), "cast_iron", 5),
    ]


def _tubes(tubes: Sequence[tuple[Point, Point, float]], low: float, thick: float) -> cq.Workplane:
    """Return straight tubes with round ends, as one plate."""
    shapes = [extruded(hull([(*a, half), (*b, half)]), thick, low) for a, b, half in tubes]
    whole = shapes[0]
    for shape in shapes[1:]:
        whole = whole.union(shape)
    return whole
