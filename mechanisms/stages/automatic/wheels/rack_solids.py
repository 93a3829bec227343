"""The solids of a rack (rmm): the toothed bar, and the studs or posts that carry it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.layout.plan import Foot
from mechanisms.stages.automatic.wheels.racks import BACK, STUD, Rack
from shared.shapes.build import extruded
from shared.shapes.involute import rack_outline, wire
from shared.shapes.outline import circle
from shared.shapes.solid import placed

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan


@build.register(Rack)
def build_rack(rack: Rack, plan: Plan, heights: Heights) -> None:
    """A steel bar; in its body's layer it is part of the plate."""
    first, last = rack.teeth
    outline = rack_outline(
        last - first + 1,
        rack.module,
        rack.tip,
        rack.root,
        BACK,
        rack.play / 2,
        (rack.phase or 0.0) + first * rack.pitch,
    )
    bar = placed(extruded(wire(outline), heights.thickness), rack.x, rack.y, turn=math.degrees(rack.angle))
    z, seat = heights.bottom(rack.layer), plan.layout.sizes.pivot.fit.seat
    if rack.body == "ground":
        low, high = seat, z - seat
    elif heights.bottom(rack.body) == z:
        plan.plate(rack.body, bar, (rack.x, rack.y, 0.0))
        return
    elif heights.bottom(rack.body) < z:
        low, high = heights.top(rack.body) + seat, z - seat
    else:
        low, high = heights.top(rack.layer) + seat, heights.bottom(rack.body) - seat
    plan.make(rack.body, f"rack_{rack.name}", placed(bar, z=z), "steel", 0)
    for k, (x, y) in enumerate(rack.seats(plan.layout)):
        stud = extruded(circle(x, y, STUD), high - low, low)
        plan.make(rack.body, f"stud_{rack.name}_{k + 1}", stud, "aluminium", 0)
        if rack.body == "ground":
            plan.feet.append(Foot("", x, y, STUD + 2.0))
