"""The solids of gears and pulleys on shafts (mm): toothed discs with a milled-out web, and rims for belts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import cadquery as cq

from mechanisms.stages.automatic.wheels.gear_solids import HUB, shape_of
from mechanisms.stages.automatic.wheels.pulley_solids import rim_of
from mechanisms.stages.automatic.wheels.pulleys import Pulley
from shared.shapes.genus import through_holes
from shared.shapes.link import Eye
from shared.shapes.solid import Solid, placed

if TYPE_CHECKING:
    from mechanisms.stages.automatic.shafts.mounted.wheels import ShaftWheel

SEAT = 0.02


def wheel_solids(own: ShaftWheel, shaft: float, seat: float) -> list[Solid]:
    """A wheel on a shaft of that radius, in the frame of its body; ``seat`` (rmm) is between a pulley and its rim."""
    wheel, unit = own.wheel, own.unit
    thickness, low = own.thickness / unit, own.mounted.low / unit
    bore = 2 * (shaft + SEAT) / unit
    eye = Eye(max(HUB, bore / 2 + 2.0), bore)
    shape, _ = shape_of(wheel, thickness, [(0.0, 0.0, eye)])
    kind = "pulley" if isinstance(wheel, Pulley) else "gear"
    pieces = [Solid(f"{kind}_{wheel.name}", placed(shape, wheel.x, wheel.y, low), "aluminium", 1)]
    if isinstance(wheel, Pulley):
        pieces.append(rim_of(wheel, thickness, low, seat))
    return [_scaled(piece, unit) for piece in pieces]


def _scaled(piece: Solid, unit: float) -> Solid:
    shape = cq.Workplane(obj=piece.shape.val().scale(unit))
    holds = tuple(replace(hold, z=hold.z * unit, radius=hold.radius * unit) for hold in piece.holds)
    return replace(piece, shape=shape, holds=holds, through_holes=through_holes(shape))
