"""Which wheel of a body lies in its body's layer: the largest, unless what else is there is in the way.

A cam, a wheel on a road or a Geneva wheel fills its body's layer: what touches it would meet the teeth. An arm does so
only where it meets the mates; then thinner pins are tried first. All other wheels lie in layers of their own, on tubes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.features import FORCE_KINDS
from mechanisms.stages.automatic.layout.items import Item, Reach
from mechanisms.stages.automatic.wheels.pulleys import Belt, Pulley
from mechanisms.stages.automatic.wheels.wheels import LEAST_ON_TUBE, Wheel

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.layout import Layout


def enter(wheels: Sequence[Wheel], layout: Layout) -> None:
    """Enter the wheels by their bodies; of each the largest lies in its layer, unless a ring's bottom or, of pulleys,
    an arm does: a belt would run through that.
    """
    by_body: dict[str, list[Wheel]] = {}
    for wheel in wheels:
        by_body.setdefault(wheel.body, []).append(wheel)
    for body, here in by_body.items():
        layout.wheels[body] = [*here]
        largest = max(here, key=lambda wheel: wheel.radius)
        for wheel in here:
            alone = not any(other.ring for other in here)
            wheel.shares = wheel is largest and alone and not _has_arm(wheel, layout)


def with_own_layers(layout: Layout, beside_arms: bool) -> Layout:
    """The layout, all of whose features are known, with wheels on tubes where their body's layer has no room;
    ``beside_arms``: also where an arm is in the way of their mates.
    """
    wheels = [
        wheel for wheel in layout.features if isinstance(wheel, Wheel) and wheel.body != "ground" and wheel.shares
    ]
    wide = [wheel for wheel in wheels if wheel.radius >= LEAST_ON_TUBE]
    filled = {getattr(feature, "fills", "") for feature in layout.features}
    beside = [wheel for wheel in wide if wheel.body not in filled and beside_arms and _meets_an_arm(wheel, layout)]
    moved = [wheel for wheel in wide if wheel.body in filled or wheel in beside]
    for wheel in moved:
        wheel.shares = False
    return replace(layout, tubes=bool(beside)) if moved else layout


def _meets_an_arm(wheel: Wheel, layout: Layout) -> bool:
    """Whether its mates, or its belt, meet what else its body has in its layer."""
    mates: list[object] = [*wheel.mates]
    mates += [belt for belt in layout.features if isinstance(belt, Belt) and wheel in belt.pulleys]
    near = [item for item in layout.items if item.source in mates and item.body != wheel.body]
    own = [item for item in layout.items if item.body == wheel.body and item.source is not wheel]
    own = [item for item in own if _is_always_in(item, wheel.body)]
    return any(layout.may_meet(a, b) and layout.gap(a, b)[0] < layout.sizes.room for a in own for b in near)


def _is_always_in(item: Item, layer: str) -> bool:
    reach = item.reach
    return isinstance(reach, Reach) and layer in reach.bodies and reach.low <= 0 <= reach.high


def _has_arm(wheel: Wheel, layout: Layout) -> bool:
    """Whether a joint, a spring, a traced point or a bar's end is on a pulley's body beyond the pulley."""
    if not isinstance(wheel, Pulley):
        return False
    m, body = layout.m, layout.m.bodies[wheel.body]
    forces = [force for force in m.forces.values() if force.kind.name in FORCE_KINDS]
    markers = [end for element in (*m.joints.values(), *forces) for end in (element.i, element.j)]
    markers += m.traces.values()
    places = [layout.place(marker) for marker in markers if marker.body.name == wheel.body] or [(wheel.x, wheel.y)]
    if body.length is not None:
        places += [(0.0, 0.0), (layout.sizes.of_metres(body.length), 0.0)]
    reach = max(math.dist(place, (wheel.x, wheel.y)) for place in places)
    return reach + layout.sizes.hardware > wheel.root
