"""The solids of a Geneva drive (rmm): wheel, locking disc with its collar, pin and roller."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.cams.geneva import GenevaDrive
from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.slides.slot_solids import slot_pin
from shared.shapes.build import bore, extruded
from shared.shapes.outline import circle
from shared.shapes.solid import placed

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan

ROOM = 1.0
"""Between what stands on the crank's axis and the locking disc round it."""
COLLAR = 2.5
"""Wall of the collar that carries the locking disc."""


@build.register(GenevaDrive)
def geneva_solids(drive: GenevaDrive, plan: Plan, heights: Heights) -> None:
    """The wheel becomes its body's plate; all else moves with the crank."""
    fit, shape = plan.layout.sizes.pivot.fit, drive.shape
    x, y, angle = drive.wheel_at
    wheel = placed(shape.wheel(heights.thickness), x, y, turn=math.degrees(angle))
    plan.plate(drive.wheel, wheel, (x, y, shape.bottom))
    slot_pin(drive.pin, plan, heights)
    x, y, angle = drive.crank_at
    hole = plan.layout.sizes.hardware + ROOM
    disc = shape.locking_disc(heights.thickness, hole)
    low = heights.bottom(drive.wheel)
    plan.make(drive.crank, f"lock_{drive.name}", placed(disc, x, y, low, math.degrees(angle)), "steel", 1)
    if heights.bottom(drive.crank) < low:
        start, end = heights.top(drive.crank), low
    else:
        start, end = low + heights.thickness, heights.bottom(drive.crank)
    start, end = start + fit.seat, end - fit.seat
    collar = extruded(circle(0, 0, hole + COLLAR), end - start).cut(bore(2 * hole, 0.0, end - start))
    plan.make(drive.crank, f"collar_{drive.name}", placed(collar, x, y, start), "steel", 1)
