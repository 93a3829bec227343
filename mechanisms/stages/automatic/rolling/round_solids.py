"""The solids of balls, wheels with tyres, and discs (rmm)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.rolling.rounds import Round
from shared.shapes.build import extruded
from shared.shapes.outline import circle
from shared.shapes.pin import washer
from shared.shapes.solid import placed
from shared.shapes.stud import ball as sphere
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan

HOLES = 5
WIDE = 9.0
"""A wheel with so much between hub and tyre (rmm), and with nothing but its axle on it, has round holes."""


@build.register(Round)
def round_solids(part: Round, plan: Plan, heights: Heights) -> None:
    """As it looks."""
    plan.outer[part] = plan.main[part.body]
    {"ball": ball, "wheel": tyred_wheel, "disc": plain_disc}[part.look](part, plan, heights)


def tyred_wheel(wheel: Round, plan: Plan, heights: Heights) -> None:
    """A disc with holes becomes its body's plate, with a tyre round it.

    Raises UserError if it is pressed in farther than a tyre can be thick.
    """
    fit, (x, y), hub = plan.layout.sizes.pivot.fit, wheel.at, wheel.hub(plan.layout)
    tyre = wheel.tyre(plan.layout)
    if wheel.pressed > tyre:
        scale = plan.layout.sizes.scale
        raise UserError(
            f"{plan.layout.m.name}: '{wheel.name}' lets the wheel of {wheel.body} be pressed "
            f"{wheel.pressed * scale:.4g} mm into what it runs on, and with a radius of {wheel.made * scale:.4g} mm "
            f"its tyre is {tyre * scale:.4g} mm thick at most; make the contact stiffer or the radius larger, "
            "or let the wheel start nearer to the surface"
        )
    rim = wheel.rim(plan.layout)
    shape = extruded(circle(0, 0, rim), heights.thickness).faces("|Z").edges().chamfer(0.4)
    alone = all(math.hypot(a.x - x, a.y - y) < 0.01 for a in plan.layout.anchors[wheel.body])
    holes = HOLES if alone and rim - hub > WIDE else 0
    for k in range(holes):
        tool = extruded(circle((hub + rim) / 2, 0, 0.3 * (rim - hub)), heights.thickness + 2.0, -1.0)
        shape = shape.cut(placed(tool, turn=360.0 * k / holes))
    plan.plate(wheel.body, placed(shape, x, y), (x, y, hub + 0.1 if holes else rim - 0.5), holes)
    band = washer(2 * (rim + fit.seat), 2 * wheel.made, heights.thickness, chamfer=0.25 * tyre)
    plan.outer[wheel] = plan.make(
        wheel.body, f"tyre_{wheel.name}", placed(band, x, y, heights.bottom(wheel.body)), "rubber", 1
    )


def ball(ball: Round, plan: Plan, heights: Heights) -> None:
    """A ball is its body, its middle in the middle of the layer."""
    (x, y), z = ball.at, heights.thickness / 2
    shape = sphere(ball.made)
    plan.plate(ball.body, placed(shape, x, y, z), (x, y, ball.made + 0.1))


def plain_disc(disc: Round, plan: Plan, heights: Heights) -> None:
    """A disc is part of its body's plate."""
    x, y = disc.at
    edge = min(0.4, 0.1 * disc.made)
    shape = extruded(circle(x, y, disc.made), heights.thickness).faces("|Z").edges().chamfer(edge)
    plan.plate(disc.body, shape, (x, y, disc.made + 0.1))
