"""The automatic parts, and a scale in degrees behind the tip, on which one reads the swing."""

from __future__ import annotations

from math import cos, degrees, radians, sin

import cadquery as cq

from mechanisms.automatic import automatic
from mechanisms.cam_follower_angular.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.build import extruded
from shared.shapes.engraving import engraved, groove
from shared.shapes.solid import Solid, placed
from shared.shapes.units import mm
from shared.shapes.workpieces import prism

SCALE = (9.0, 30.0)
"""Start of the scale beyond the tip's eye, and its width (mm)."""
BEYOND, STEP = 5, 2
"""Degrees beyond the swing, and from stroke to stroke."""
POINTER = (2.0, 3.5)
"""Distance between the arm and the scale, and half the arm's width (mm)."""


def parts(p: Params) -> Bodies:
    """By body."""
    m = build(p)
    sol = m.sweep()
    made = automatic(m, solution=sol)
    eye = made.sizes.eye * made.sizes.scale
    theta = [degrees(float(value)) for value in (sol.body("arm").theta.min(), sol.body("arm").theta.max())]
    inner = mm(p.tip) + eye + SCALE[0]
    outer = inner + SCALE[1]
    far = [(mm(p.pivot) + outer * cos(radians(angle)), outer * sin(radians(angle))) for angle in theta]
    made.base_under((min(x for x, _ in far) - 4.0, 0.0), (0.0, max(y for _, y in far) + 10.0))
    solids = made.solids()
    low, high = made.span("arm")
    seat = made.sizes.pivot.fit.seat
    plate = placed(_scale(inner, outer, theta, seat, high), mm(p.pivot))
    solids.dress("ground", Solid("scale", plate, "brass", 0))
    near, half = POINTER
    start = mm(p.tip) + eye + seat
    tip = prism([(start, -half), (inner - near, 0.0), (start, half)], low, high)
    solids.dress("arm", Solid("pointer", tip, "aluminium_red", 0))
    return solids


def _scale(inner: float, outer: float, theta: list[float], low: float, high: float) -> cq.Workplane:
    """A sector with strokes, the zero of its angles on the x axis; every fifth stroke is long."""
    first, last = int(theta[0]) - BEYOND, int(theta[1]) + BEYOND + 1

    def point(radius: float, angle: float) -> tuple[float, float]:
        return radius * cos(radians(angle)), radius * sin(radians(angle))

    edge = [point(inner, angle) for angle in range(first, last + 1)] + [
        point(outer, angle) for angle in range(last, first - 1, -1)
    ]
    outline = cq.Wire.makePolygon([cq.Vector(x, y, 0.0) for x, y in edge], close=True)
    strokes = []
    for k, angle in enumerate(range(first + STEP, last, STEP)):
        long = 12.0 if k % 5 == 0 else 7.0
        strokes.append(groove(point(inner + 3.0, angle), point(inner + 3.0 + long, angle), 0.9))
    return engraved(extruded(outline, high - low, low), strokes, high)
