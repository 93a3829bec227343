"""A shaft in pieces, for rods whose big ends are of one piece: its pins are pressed into the webs above (mm)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from shared.shapes import outline
from shared.shapes.build import extruded

if TYPE_CHECKING:
    from collections.abc import Sequence

    import cadquery as cq

    from mechanisms.stages.automatic.shafts.shaft_plan import Pin, ShaftPlan

SEAT = 0.02
BEYOND = 0.01
"""How far a pin reaches into what it is made one with."""


def built_up(shape: cq.Workplane, plan: ShaftPlan, pins: Sequence[Pin]) -> list[cq.Workplane]:
    """Pieces of a shaft from its lower end up, one more than ``pins``; each of these belongs to the piece below."""
    import cadquery as cq

    pieces = [shape]
    far = 4 * (plan.swept + plan.top - plan.ends[0])
    for pin in pins:
        x, y = plan.shaft.axis[0] + pin.x, plan.shaft.axis[1] + pin.y
        whole, top = pieces.pop(), next(web.high for web in plan.webs if web.low == pin.high)
        below = cq.Workplane().box(far, far, far, centered=(True, True, False)).translate((0, 0, pin.high - far))
        pressed = extruded(outline.circle(x, y, plan.pin), top - pin.high + BEYOND, pin.high - BEYOND)
        hole = extruded(outline.circle(x, y, plan.hole), top - pin.high + 2, pin.high - 1) if plan.hole else None
        lower = whole.intersect(below).union(pressed)
        upper = whole.cut(below).cut(extruded(outline.circle(x, y, plan.pin + SEAT), top - pin.high + 2, pin.high - 1))
        pieces += [lower if hole is None else lower.cut(hole), upper]
    return pieces
