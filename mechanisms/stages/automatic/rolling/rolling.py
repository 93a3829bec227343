"""Discs that roll on a line or a curve: a wheel with a tyre, and the road as a wall on the base, or on a moving body;
closed curves are rings round the wheel, or discs (tracks.py).

Wheel and road touch by design; they are made with the clearance of a cam and its roller.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.extents import Extent, extent
from mechanisms.stages.automatic.layout.features import kind
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.layout.profiles import curve_path, farthest, on_body
from mechanisms.stages.automatic.rolling.roads import along
from mechanisms.stages.automatic.rolling.rounds import round_at
from mechanisms.stages.automatic.rolling.surfaces import rolled_road
from mechanisms.stages.automatic.rolling.tracks import track
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Layout

BEYOND = 0.8
"""How far a straight road goes on beyond the wheel's travel, in the wheel's radii."""
LEAST = 17.0
"""Least radius of a wheel (rmm): an eye lies within its tyre."""


@kind("rolling_disc")
def on_lines(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """A wheel and a road for each joint."""
    features: list[Feature] = []
    for joint in joints:
        _refuse(m, joint)
        start, angle = np.array(layout.place(joint.i)), joint.i.angle
        way = np.array([math.cos(angle), math.sin(angle)])
        travel = (layout.seen(joint.j.body.name, layout.place(joint.j), joint.i.body.name) - start) @ way
        beyond = BEYOND * layout.sizes.of_metres(joint.params["radius"])
        ends = np.array([travel.min() - beyond, travel.max() + beyond])
        features += _rolling(joint, start + ends[:, None] * way, False, layout)
    return features


@kind("rolling_on_curve")
def on_curves(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """A wheel and a road for each joint."""
    features: list[Feature] = []
    for joint in joints:
        _refuse(m, joint)
        closed = bool(joint.params["closed"])
        path = on_body(curve_path(joint.params["points"], True), joint.i, layout) if closed else None
        features += _rolling(joint, path, closed, layout)
    return features


def _rolling(joint: Joint, path: np.ndarray | None, closed: bool, layout: Layout) -> list[Feature]:
    """Wheel and road; without a ``path`` the road is along the joint's open curve."""
    radius = layout.sizes.of_metres(joint.params["radius"])
    wheel, new = round_at(layout, joint.name, joint.j.body.name, layout.place(joint.j), radius, "wheel")
    body, features = joint.i.body.name, [wheel] if new else []
    if path is not None and closed:
        return [*features, track(joint.name, body, wheel, path, True)]
    road = rolled_road(joint, wheel, layout) if path is None else along(joint.name, [wheel], path)
    if body == "ground":
        return [*features, road]
    return [*features, track(joint.name, body, wheel, road.path, False, road)]


def _refuse(m: Mechanism, joint: Joint) -> None:
    if joint.j.body.name == "ground":
        raise UserError(
            f"{m.name}: joint '{joint.name}' is a {joint.kind.name.replace('_', ' ')} whose disc is on ground; "
            f"it has no automatic parts yet; write {shown_file(m.name, 'parts')}"
        )


@extent("rolling_disc")
@extent("rolling_on_curve")
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """The wheel, and a closed curve."""
    radius = joint.params["radius"]
    round_it = ((joint.i, farthest(joint.params["points"])),) if joint.params.get("closed") else ()
    return Extent(((joint.j, radius), *round_it), ((radius, LEAST),))
