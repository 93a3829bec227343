"""The solids of pins with nothing beyond their plates (rmm): sunk pivots, and pins of built-up cranks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechanisms.stages.automatic.pins.pin_solids import run, standing
from shared.shapes.build import bore
from shared.shapes.link import Eye
from shared.shapes.pin import Head, bushing, pin
from shared.shapes.solid import placed

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan
    from mechanisms.stages.automatic.pins.pins import Pin

SUNK = Head(14.0, 1.4, 0.3)
"""Head of a pivot that is sunk into its link."""
UNDER = 0.3
"""How far such a head, or the end of a pin, is under the face of the plate."""


def flush_pivot(joint: Pin, plan: Plan, heights: Heights) -> None:
    """A pedestal with a fixed pin whose head is in a counterbore of the one link on it, so that nothing is above it."""
    sizes, name, (body,) = plan.layout.sizes, joint.name, joint.movers
    pivot, fit = sizes.pivot, sizes.pivot.fit
    x, y = joint.places["ground"]
    u, v = joint.places[body]
    bottom = heights.bottom(body)
    height = bottom - pivot.flange_room - fit.axial - pivot.washer_room
    standing(name, (x, y), height, plan, dial=joint.driven, levels=heights.levels)
    depth = SUNK.height + fit.axial + UNDER
    floor = heights.thickness - depth
    plan.eye(body, u, v, Eye(sizes.eye, pivot.running))
    plan.cut(body, placed(bore(SUNK.diameter + fit.running + 0.4, floor + 0.5, heights.thickness + 1.0), u, v), 0)
    barrel = bushing(pivot.bored(joint.play), pivot.bushing, pivot.flange, pivot.flange_thickness, floor - 0.1)
    barrel = barrel.rotate((0, 0, 0), (1, 0, 0), 180)
    plan.make(body, f"bushing_{name}", placed(barrel, u, v, bottom - fit.seat), "bronze", 1)
    end = bottom + floor + fit.axial
    plan.make("ground", f"pin_{name}", placed(pin(pivot.pin, end - 0.5, SUNK), x, y, 0.5), "steel", 0)
    plan.add("ground", pivot.washer_at(f"washer_{name}", x, y, height + fit.seat))


def crank_pin(joint: Pin, stack: list[str], plan: Plan, heights: Heights) -> None:
    """A pin pressed into two webs of one body, the ends of ``stack``; the others turn between them."""
    sizes, name = plan.layout.sizes, joint.name
    pivot, fit = sizes.pivot, sizes.pivot.fit
    low, *runners, high = stack
    x, y = joint.places[low]
    top, under = heights.top(low), heights.bottom(high)
    room = pivot.flange_room + fit.axial + pivot.washer_room
    above, below = (_boss(gap - room) for gap in (heights.bottom(runners[0]) - top, under - heights.top(runners[-1])))
    radius = min(9.5, sizes.hardware)
    plan.eye(low, x, y, Eye(sizes.eye - 0.5, pivot.held, above=above, boss=radius))
    plan.eye(high, x, y, Eye(sizes.eye - 0.5, pivot.held, below=below, boss=radius))
    run(joint, runners, low, plan, heights)
    start, end = heights.bottom(low) + UNDER, heights.top(high) - UNDER
    plan.make(low, f"pin_{name}", placed(pin(pivot.pin, end - start), x, y, start), "steel", 0)
    plan.add(
        low,
        pivot.washer_at(f"washer_{name}_low", x, y, top + above + fit.seat),
        pivot.washer_at(f"washer_{name}_high", x, y, under - below - pivot.washer_room),
    )


def _boss(height: float) -> float:
    return height if height > 0.05 else 0.0
