"""A shaft as one solid: journals, webs with counterweights, crank pins, a snout and a flange (mm)."""

from __future__ import annotations

import math
from functools import partial
from itertools import combinations
from typing import TYPE_CHECKING

from shared.shapes import outline
from shared.shapes.build import eased, extruded, turned
from shared.shapes.kernel import first_sound

if TYPE_CHECKING:
    from collections.abc import Sequence

    import cadquery as cq

    from mechanisms.stages.automatic.shafts.shaft_plan import ShaftPlan, Web
    from shared.shapes.outline import Circle

SECTOR = math.radians(62)
"""Half of a counterweight's angle about the axis."""
INTO = 0.3
"""Of a web's thickness, how far pins and journals reach into it."""
EDGE = 0.018


def shaft_solid(plan: ShaftPlan, flywheel: float = 0.0) -> cq.Workplane:
    """The shaft in its body's frame; ``flywheel`` is the radius of a disc at its lower end, 0 for none."""
    edge = EDGE * plan.unit
    shape = _web(plan, plan.webs[0], edge)
    for web in plan.webs[1:]:
        shape = shape.union(_web(plan, web, edge))
    into = INTO * min(web.high - web.low for web in plan.webs)
    for pin in plan.pins:
        shape = shape.union(_rod(plan.pin, pin.low - into, pin.high + into, (pin.x, pin.y)))
    for journal in plan.journals[1:-1]:
        shape = shape.union(_rod(plan.journal, journal.low - into, journal.high + into))
    shape = shape.union(_upper_end(plan, into)).union(_lower_end(plan, into, flywheel))
    x, y = plan.shaft.axis
    return shape.translate((x, y, 0))


def _rod(radius: float, low: float, high: float, at: tuple[float, float] = (0.0, 0.0)) -> cq.Workplane:
    return extruded(outline.circle(*at, radius), high - low, low)


def _web(plan: ShaftPlan, web: Web, edge: float) -> cq.Workplane:
    height = web.high - web.low
    circles = [(0.0, 0.0, plan.neck), *((x, y, plan.cheek) for x, y in web.pins)]
    shape = _hulls(circles, height, web.low)
    if web.weight and plan.has_weights:
        ((x, y),) = web.pins
        shape = shape.union(_counterweight(plan, math.atan2(y, x) + math.pi, height, web.low))
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


def _counterweight(plan: ShaftPlan, towards: float, height: float, z: float) -> cq.Workplane:
    import cadquery as cq

    def at(radius: float, turn: float) -> tuple[float, float]:
        return radius * math.cos(towards + turn), radius * math.sin(towards + turn)

    neck = plan.neck
    flat = cq.Workplane(origin=(0, 0, z)).moveTo(*at(neck, -math.pi / 2)).lineTo(*at(plan.counterweight, -SECTOR))
    flat = flat.threePointArc(at(plan.counterweight, 0.0), at(plan.counterweight, SECTOR))
    return flat.lineTo(*at(neck, math.pi / 2)).close().extrude(height)


def _upper_end(plan: ShaftPlan, into: float) -> cq.Workplane:
    """The last journal, and a thinner snout beyond it."""
    low, high, top = plan.journals[-1].low - into, plan.journals[-1].high, plan.top
    r, thin, c = plan.journal, 0.7 * plan.journal, 0.03 * plan.unit
    return turned(
        [(0, low), (r, low), (r, high - c), (r - c, high), (thin, high), (thin, top - c), (thin - c, top), (0, top)]
    )


def _lower_end(plan: ShaftPlan, into: float, flywheel: float) -> cq.Workplane:
    """The first journal, and a flange below it, or a flywheel."""
    high, low, end = plan.journals[0].high + into, plan.journals[0].low, plan.bottom(flywheel)
    r, wide, c = plan.journal, flywheel or 1.4 * plan.journal, 0.03 * plan.unit
    profile = [(0, high), (r, high), (r, low)]
    if flywheel:
        hub, rim = 1.4 * r, flywheel - 0.22 * (flywheel - 1.4 * r)
        dish = 0.25 * (low - end)
        profile += [(hub, low), (hub, low - dish), (rim, low - dish), (rim, low)]
    profile += [(wide - c, low), (wide, low - c), (wide, end + c), (wide - c, end), (0, end)]
    return turned(profile)
