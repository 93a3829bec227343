"""The solids of a bridge (rmm): two posts, a beam that is pinned to them, and shafts that hang from it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.pins.bridges import BEAM, Bridge
from mechanisms.stages.automatic.pins.pin_solids import FOOT, TOP, run, standing
from shared.shapes import outline
from shared.shapes.base import column
from shared.shapes.build import bore, eased, extruded
from shared.shapes.pin import pin
from shared.shapes.solid import placed as placed_solid

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan
    from mechanisms.stages.automatic.pins.pins import Pin

BEAM_HEIGHT = 11.0
DOWEL = 24.0
"""Length of the pins that hold a beam on its posts."""


@build.register(Bridge)
def bridge_solids(bridge: Bridge, plan: Plan, heights: Heights) -> None:
    """All of a bridge, and what hangs from it."""
    sizes = plan.layout.sizes
    pivot, seat, low = sizes.pivot, sizes.pivot.fit.seat, heights.roof
    (x0, y0), (x1, y1) = bridge.ends
    shape = extruded(outline.hull([(x0, y0, BEAM / 2), (x1, y1, BEAM / 2)]), BEAM_HEIGHT, low)
    shape = eased(shape, 1.2, ">Z", chamfer=True)
    hung = [pin.places["ground"] for pin in bridge.pins]
    for x, y in [*bridge.ends, *hung]:
        shape = shape.cut(placed_solid(bore(pivot.held, low, low + BEAM_HEIGHT, 0.4), x, y))
    plan.make("ground", f"bridge_{bridge.name}", shape, "aluminium_black", 2 + len(hung))
    for k, (x, y) in enumerate(bridge.ends, start=1):
        standing(f"{bridge.name}_{k}", (x, y), low - seat, plan, label="", kind="post", levels=heights.levels)
        dowel = pin(pivot.pin, DOWEL - seat, sizes.head)
        top = low + BEAM_HEIGHT + seat
        plan.make("ground", f"dowel_{bridge.name}_{k}", placed_solid(dowel, x, y, top - DOWEL + seat), "steel", 0)
    for hanging in bridge.pins:
        _shaft(hanging, plan, heights)


def _shaft(joint: Pin, plan: Plan, heights: Heights) -> None:
    """A shaft in the beam, with a boss under it; what turns on it, and a circlip under the lowest."""
    sizes, name = plan.layout.sizes, joint.name
    pivot, fit = sizes.pivot, sizes.pivot.fit
    x, y = joint.places["ground"]
    stack = sorted(joint.movers, key=lambda body: heights.bottom(body))
    low = heights.top(stack[-1]) + pivot.flange_room + fit.axial + pivot.washer_room
    boss = column(heights.roof - fit.seat - low, pivot.held, TOP, FOOT).rotate((0, 0, 0), (1, 0, 0), 180)
    plan.make("ground", f"boss_{name}", placed_solid(boss, x, y, heights.roof - fit.seat), "aluminium", 1)
    run(joint, stack, "ground", plan, heights)
    clip = heights.bottom(stack[0]) - pivot.flange_room - pivot.retainer_room
    start, top = clip - sizes.pin_end, heights.roof + BEAM_HEIGHT + fit.seat
    bolt = pin(pivot.pin, top - start, sizes.head, pivot.groove(clip - start))
    plan.make("ground", f"pin_{name}", placed_solid(bolt, x, y, start), "steel", 0)
    plan.add(
        "ground",
        pivot.washer_at(f"washer_{name}_high", x, y, low - pivot.washer_room),
        pivot.washer_at(f"washer_{name}_low", x, y, clip + pivot.clip_thickness + fit.seat),
        pivot.clip_at(f"circlip_{name}", x, y, clip, turn=225),
    )
