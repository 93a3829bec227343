"""The solids of a wheel on a road (rmm): a disc with holes, a tyre round it, a wall on the base."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import cadquery as cq

from mechanisms.automatic.plan import Foot
from shared.shapes.build import extruded
from shared.shapes.outline import circle
from shared.shapes.pin import washer
from shared.shapes.solid import placed

if TYPE_CHECKING:
    from mechanisms.automatic.heights import Heights
    from mechanisms.automatic.plan import Plan
    from mechanisms.automatic.rolling import Rolling

ROAD = 10.0
"""Thickness of the road under its surface."""
TYRE = 0.16
"""Of the wheel's radius; 5 rmm at most."""
HOLES = 5
WIDE = 32.0
"""A wheel with this radius, and with nothing but its axle on it, has round holes."""


def rolling_solids(rolling: Rolling, plan: Plan, heights: Heights) -> None:
    """The wheel becomes its body's plate; the road stands on the base up to the wheel's upper face."""
    fit, (x, y) = plan.layout.sizes.pivot.fit, rolling.at
    tyre = min(TYRE * rolling.radius, 5.0)
    rim = rolling.radius - tyre - fit.seat
    shape = extruded(circle(0, 0, rim), heights.thickness).faces("|Z").edges().chamfer(0.4)
    alone = all(math.hypot(a.x - x, a.y - y) < 0.01 for a in plan.layout.anchors[rolling.wheel])
    holes = HOLES if alone and rim > WIDE - 5.0 else 0
    for k in range(holes):
        at = (plan.layout.sizes.eye + rim) / 2
        tool = extruded(circle(at, 0, 0.3 * (rim - plan.layout.sizes.eye)), heights.thickness + 2.0, -1.0)
        shape = shape.cut(placed(tool, turn=360.0 * k / holes))
    plan.plate(rolling.wheel, placed(shape, x, y), (x, y, plan.layout.sizes.eye + 0.1 if holes else rim - 0.5), holes)
    band = washer(2 * (rim + fit.seat), 2 * rolling.radius, heights.thickness, chamfer=0.25 * tyre)
    z = heights.bottom(rolling.wheel)
    plan.make(rolling.wheel, f"tyre_{rolling.name}", placed(band, x, y, z), "rubber", 1)
    top = z + heights.thickness
    road = cq.Workplane(obj=_road(rolling, top - fit.seat).translate(cq.Vector(0, 0, fit.seat)))
    plan.make("ground", f"road_{rolling.name}", road, "aluminium", 0)
    beside = rolling.road[[0, -1]] - rolling.radius * rolling.under  # the base plate goes on under the wheel
    plan.feet += [Foot("", float(u), float(v), ROAD) for u, v in (*rolling.road[[0, -1]], *beside)]


def _road(rolling: Rolling, height: float) -> cq.Solid:
    """A wall: one side is the road's surface, smooth where that is a curve, the other is straight."""
    path = rolling.road
    ends = [path[k] + rolling.depth(path[k]) * rolling.under for k in (-1, 0)]
    points = [cq.Vector(float(u), float(v), 0.0) for u, v in (*path, *ends)]
    count = len(path)
    surface = cq.Edge.makeSpline(points[:count]) if count > 2 else cq.Edge.makeLine(points[0], points[1])
    corners = [points[count - 1], points[count], points[count + 1], points[0]]
    sides = [cq.Edge.makeLine(a, b) for a, b in pairwise(corners)]
    return cq.Solid.extrudeLinear(cq.Wire.assembleEdges([surface, *sides]), [], cq.Vector(0, 0, height))
