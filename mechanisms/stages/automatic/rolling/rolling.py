"""Discs that roll on a line or a terrain of ground: a wheel with a tyre, and the road as a wall on the base.

Wheel and road touch by design; they are made with the clearance of a cam and its roller.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.extents import Extent, extent
from mechanisms.stages.automatic.layout.features import kind
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.layout.profiles import curve_path, on_body
from mechanisms.stages.automatic.rolling.roads import along
from mechanisms.stages.automatic.rolling.rounds import round_at
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Layout

BEYOND = 0.8
"""How far a straight road goes on beyond the wheel's travel, in the wheel's radii."""
LEAST = 16.0
"""Least radius of a wheel (rmm)."""


@kind("rolling_disc")
def on_lines(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """A wheel and a road for each joint."""
    found: list[Feature] = []
    for joint in joints:
        _refuse(m, joint)
        start, angle = np.array(layout.place(joint.i)), joint.i.angle
        way = np.array([math.cos(angle), math.sin(angle)])
        travel = (layout.seen(joint.j.body.name, layout.place(joint.j), "ground") - start) @ way
        beyond = BEYOND * layout.sizes.of_metres(joint.params["radius"])
        ends = np.array([travel.min() - beyond, travel.max() + beyond])
        found += _rolling(joint, start + ends[:, None] * way, layout)
    return found


@kind("rolling_on_curve")
def on_curves(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """A wheel and a road for each joint."""
    found: list[Feature] = []
    for joint in joints:
        _refuse(m, joint)
        if joint.params["closed"]:
            raise UserError(
                f"{m.name}: joint '{joint.name}' rolls on a closed curve, which has no parts by itself yet; "
                f"write mechanisms/{m.name}/parts.py"
            )
        path = on_body(curve_path(joint.params["points"], False), joint.i, layout)
        found += _rolling(joint, path, layout)
    return found


def _rolling(joint: Joint, path: np.ndarray, layout: Layout) -> list[Feature]:
    radius = layout.sizes.of_metres(joint.params["radius"])
    wheel, new = round_at(layout, joint.name, joint.j.body.name, layout.place(joint.j), radius, "wheel")
    return [*([wheel] if new else []), along(joint.name, [wheel], path)]


def _refuse(m: Mechanism, joint: Joint) -> None:
    if joint.i.body.name != "ground" or joint.j.body.name == "ground":
        raise UserError(
            f"{m.name}: joint '{joint.name}' is a {joint.kind.name.replace('_', ' ')} whose road is not on ground; "
            f"it has no parts by itself yet; write mechanisms/{m.name}/parts.py"
        )


@extent("rolling_disc")
@extent("rolling_on_curve")
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """The wheel."""
    radius = joint.params["radius"]
    return Extent(((joint.j, radius),), ((radius, LEAST),))
