"""A shaft as one solid: journals, webs with counterweights, crank pins, a snout and a flange (mm)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechanisms.stages.automatic.shafts.shaft_plan import THIN
from shared.shapes import outline
from shared.shapes.build import extruded, turned

if TYPE_CHECKING:
    from collections.abc import Sequence

    import cadquery as cq

    from mechanisms.stages.automatic.shafts.shaft_plan import ShaftPlan

INTO = 0.3
"""How far pins and journals reach into a web, in its thickness."""


def shaft_solid(plan: ShaftPlan, webs: Sequence[cq.Workplane], flywheel: float = 0.0) -> cq.Workplane:
    """The shaft in its body's frame with these webs; ``flywheel`` is the radius of a disc at its lower end, 0 for
    none.
    """
    if not plan.pins:
        return _plain(plan)
    shape = webs[0]
    for web in webs[1:]:
        shape = shape.union(web)
    into = INTO * min(web.high - web.low for web in plan.webs)
    for pin in plan.pins:
        shape = shape.union(_rod(plan.pin, pin.low - into, pin.high + into, (pin.x, pin.y)))
    for journal in plan.journals[1:-1]:
        shape = shape.union(_rod(plan.journal, journal.low - into, journal.high + into))
    shape = shape.union(_upper_end(plan, into)).union(_lower_end(plan, into, flywheel))
    for pin in plan.pins if plan.hole else ():
        webs_of = plan.beside(pin)
        low, high = min(web.low for web in webs_of), max(web.high for web in webs_of)
        shape = shape.cut(_rod(plan.hole, low - 1, high + 1, (pin.x, pin.y)))
    x, y = plan.shaft.axis
    return shape.translate((x, y, 0))


def _plain(plan: ShaftPlan) -> cq.Workplane:
    """A rod through all that sits on it."""
    low, high, r, c = plan.bottom(0.0), plan.top, plan.journal, 0.03 * plan.unit
    x, y = plan.shaft.axis
    shape = turned([(0, low), (r - c, low), (r, low + c), (r, high - c), (r - c, high), (0, high)])
    return shape.translate((x, y, 0))


def _rod(radius: float, low: float, high: float, at: tuple[float, float] = (0.0, 0.0)) -> cq.Workplane:
    return extruded(outline.circle(*at, radius), high - low, low)


def _upper_end(plan: ShaftPlan, into: float) -> cq.Workplane:
    """The last journal, and a thinner snout beyond it."""
    low, high, top = plan.journals[-1].low - into, plan.journals[-1].high, plan.top
    r, thin, c = plan.journal, THIN * plan.journal, 0.03 * plan.unit
    return turned(
        [(0, low), (r, low), (r, high - c), (r - c, high), (thin, high), (thin, top - c), (thin - c, top), (0, top)]
    )


def _lower_end(plan: ShaftPlan, into: float, flywheel: float) -> cq.Workplane:
    """The first journal, and a flange below it, or a flywheel."""
    high, low, end = plan.journals[0].high + into, plan.journals[0].low, plan.bottom(flywheel)
    r, wide, c = plan.journal, flywheel or 1.4 * plan.journal, 0.03 * plan.unit
    if not plan.has_flange and not flywheel:
        thin = THIN * r
        return turned(
            [(0, high), (r, high), (r, low + c), (r - c, low), (thin, low), (thin, end + c), (thin - c, end), (0, end)]
        )
    profile = [(0, high), (r, high), (r, low)]
    if flywheel:
        hub, rim = 1.4 * r, flywheel - 0.22 * (flywheel - 1.4 * r)
        dish = 0.25 * (low - end)
        profile += [(hub, low), (hub, low - dish), (rim, low - dish), (rim, low)]
    profile += [(wide - c, low), (wide, low - c), (wide, end + c), (wide - c, end), (0, end)]
    return turned(profile)
