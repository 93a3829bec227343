"""The solids of a cam (rmm): its disc, and the roller on its pin, or the shoe."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.cams.cams import SHOE, Cam
from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.slides.slot_solids import slot_pin
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.cam import cam_disc

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan


@build.register(Cam)
def cam_solids(cam: Cam, plan: Plan, heights: Heights) -> None:
    """The disc becomes its body's plate; roller or shoe move with the follower, at the height of the disc."""
    x, y = cam.centre
    hub = float(np.hypot(cam.outline[:, 0] - x, cam.outline[:, 1] - y).min())
    plan.plate(cam.cam, cam_disc(cam.outline, heights.thickness), (x, y, hub - 1.0))
    if cam.roller is not None:
        slot_pin(cam.pin, plan, heights, 0.0 if cam.bare else 2 * cam.roller)
        return
    seat = plan.layout.sizes.pivot.fit.seat
    if heights.bottom(cam.follower) > heights.bottom(cam.cam):
        z0, z1 = heights.bottom(cam.cam), heights.bottom(cam.follower) - seat
    else:
        z0, z1 = heights.top(cam.follower) + seat, heights.top(cam.cam)
    ends = cam.shoe()
    shape = extruded(outline.hull([(u, v, SHOE) for u, v in ends]), z1 - z0, z0)
    plan.make(cam.follower, f"shoe_{cam.name}", eased(shape, 0.5, chamfer=True), "bronze", 0)
