"""A web of a shaft, from its axis to its crank pins, and the counterweight on it (mm)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from itertools import combinations
from typing import TYPE_CHECKING

from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.kernel import first_sound

if TYPE_CHECKING:
    from collections.abc import Sequence

    import cadquery as cq

    from mechanisms.stages.automatic.shafts.shaft_plan import ShaftPlan, Web
    from shared.shapes.outline import Circle

EDGE = 0.018
"""Radius of what is rounded, in bores."""


@dataclass(frozen=True)
class Weight:
    """A counterweight: a sector about the axis, its flanks from the web's neck."""

    towards: float
    """Direction of its middle (rad)."""
    radius: float
    half: float
    """Half of its angle (rad)."""


def web_solid(plan: ShaftPlan, web: Web, weight: Weight | None = None) -> cq.Workplane:
    """A web about its shaft's axis."""
    height, edge = web.high - web.low, EDGE * plan.unit
    circles = [(0.0, 0.0, plan.neck), *((x, y, plan.cheek) for x, y in web.pins)]
    shape = _hulls(circles, height, web.low)
    if weight is not None:
        shape = shape.union(_counterweight(plan.neck, weight, height, web.low))
    made = first_sound([partial(eased, shape.clean(), size, "|Z", True) for size in (edge, edge / 2)])
    return shape if made is None else made


def _hulls(circles: Sequence[Circle], height: float, z: float) -> cq.Workplane:
    """Round all circles: the hulls of all pairs, which for a web is all that it needs."""
    wires = [_hull(a, b) for a, b in combinations(circles, 2)]
    shape = extruded(wires[0], height, z)
    for wire in wires[1:]:
        shape = shape.union(extruded(wire, height, z))
    return shape


def _hull(a: Circle, b: Circle) -> cq.Wire:
    """Round two circles; the larger alone if it holds the other."""
    if math.dist(a[:2], b[:2]) <= abs(a[2] - b[2]) + 1e-6:
        return outline.circle(*max(a, b, key=lambda circle: circle[2]))
    return outline.hull([a, b])


def _counterweight(neck: float, weight: Weight, height: float, z: float) -> cq.Workplane:
    import cadquery as cq

    def at(radius: float, turn: float) -> tuple[float, float]:
        return radius * math.cos(weight.towards + turn), radius * math.sin(weight.towards + turn)

    far, half = weight.radius, weight.half
    flat = cq.Workplane(origin=(0, 0, z)).moveTo(*at(neck, -math.pi / 2)).lineTo(*at(far, -half))
    return flat.threePointArc(at(far, 0.0), at(far, half)).lineTo(*at(neck, math.pi / 2)).close().extrude(height)
