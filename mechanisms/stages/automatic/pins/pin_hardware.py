"""Which solids a pin has, by what holds it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.pins.pin_solids import ground_pin, hanging_pin, moving_pin
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.automatic.pins.strong_pins import crank_pin, flush_pivot

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan


@build.register(Pin)
def pin_hardware(joint: Pin, plan: Plan, heights: Heights) -> None:
    """Eyes and hardware; a bridge builds what hangs from it."""
    stack = sorted(joint.movers, key=heights.bottom)
    hangs = heights.levels.get(joint.choice) == 1
    if joint.on_ground and hangs:
        return
    if joint.webs:
        crank_pin(joint, stack, plan, heights)
    elif joint.is_flush(heights.levels, plan.layout):
        flush_pivot(joint, plan, heights)
    elif joint.on_ground:
        ground_pin(joint, stack, plan, heights)
    elif hangs:
        hanging_pin(joint, stack, plan, heights)
    else:
        moving_pin(joint, stack, plan, heights)
