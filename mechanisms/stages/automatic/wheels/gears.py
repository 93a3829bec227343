"""Gear pairs, racks, belts: the wheels, racks and pulleys of all such joints, in phase, on common layers.

Wheels that mesh share a layer. A wheel that is given by radii gets a standard module if that gives whole numbers of
teeth. A wheel that several joints name is one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from mbsd.model.teeth import with_radii
from mechanisms.stages.automatic.layout.extents import Extent, extent
from mechanisms.stages.automatic.layout.features import kind
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.wheels import racks, wheels
from mechanisms.stages.automatic.wheels.belts import BELTS, belts
from mechanisms.stages.automatic.wheels.pulleys import Pulley
from mechanisms.stages.automatic.wheels.racks import Rack, add_way
from mechanisms.stages.automatic.wheels.trains import Mesh, in_phase
from mechanisms.stages.automatic.wheels.wheels import Wheel

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.model.body import Marker
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Layout

GEARS, RACKS = "gear_pair", "rack_and_pinion"
SAME = 0.02
"""Wheels nearer than this (rmm) have one centre."""


@extent(GEARS)
def extent_of_gears(joint: Joint, solution: Solution) -> Extent:
    """Both wheels; smaller ones of a stepped gear have room for the tube they sit on."""
    sized = with_radii(joint.params)
    both = (joint.i, sized["radius_i"]), (joint.j, sized["radius_j"])
    least = tuple((radius, _least(marker, radius, solution.mechanism)) for marker, radius in both)
    return Extent(both, least)


@extent(RACKS)
def extent_of_rack(joint: Joint, solution: Solution) -> Extent:
    """The pinion."""
    radius = with_radii(joint.params)["radius"]
    return Extent(((joint.j, radius),), ((radius, racks.LEAST),))


@kind(BELTS)
@kind(RACKS)
@kind(GEARS)
def gather(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """All wheels, racks and pulleys of the mechanism, in phase, when the first of these kinds is asked for."""
    if any(layout.wheels.values()):
        return []
    found: list[Wheel] = []
    bars: list[Rack] = []
    meshes: list[Mesh] = []
    for joint in (joint for joint in m.joints.values() if joint.kind.name in (GEARS, RACKS)):
        sized = with_radii(joint.params)
        if joint.kind.name == RACKS:
            first = _rack(bars, joint.name, joint.i, layout)
            second = wheel_at(found, joint.name, joint.j, sized["radius"], False, layout)
            add_way(m, first, second, joint, layout)
        else:
            ring = bool(joint.params["internal"])
            first = wheel_at(found, joint.name, joint.i, sized["radius_i"], ring, layout)
            second = wheel_at(found, joint.name, joint.j, sized["radius_j"], False, layout)
        first.mates.append(second)
        second.mates.append(first)
        meshes.append(Mesh(first, second, joint))
    in_phase(m, [*found, *bars], meshes, layout)
    bands = belts(m, layout)
    pairs: list[tuple[Wheel | Rack, Wheel]] = [belt.pulleys for belt in bands]
    pulleys = [pulley for belt in bands for pulley in belt.pulleys]
    settle([*found, *pulleys], layout)
    for rack in bars:
        layout.extra.append(rack.layer)
    pairs += [(mesh.first, mesh.second) for mesh in meshes]
    layout.together += [(one.layer, mate.layer) for one, mate in pairs]
    return [*found, *bars, *pulleys, *bands]


def wheel_at(found: list[Wheel], name: str, marker: Marker, radius: float, ring: bool, layout: Layout) -> Wheel:
    """The wheel of that pitch radius (m) about a marker: one of ``found``, or a new one that joins them."""
    (x, y), body, size = layout.place(marker), marker.body.name, layout.sizes.of_metres(radius)
    for wheel in found:
        same = wheel.body == body and math.hypot(wheel.x - x, wheel.y - y) < SAME and wheel.ring == ring
        if same and abs(wheel.radius - size) < 1e-6 * size:
            return wheel
    found.append(Wheel(name, body, x, y, size, ring))
    return found[-1]


def settle(found: Sequence[Wheel], layout: Layout) -> None:
    """Enter the wheels; of each body the largest lies in its layer, unless a ring's bottom or, of pulleys, an arm does:
    a belt would run through that.
    """
    by_body: dict[str, list[Wheel]] = {}
    for wheel in found:
        by_body.setdefault(wheel.body, []).append(wheel)
    for body, here in by_body.items():
        layout.wheels[body] = [*here]
        outer = [wheel for wheel in here if not wheel.ring]
        largest = max(outer, key=lambda wheel: wheel.radius, default=None)
        for wheel in here:
            wheel.shares = wheel is largest and len(outer) == len(here) and not _has_arm(wheel, layout)
    layout.extra += [wheel.layer for wheel in found if wheel.body == "ground" or not wheel.shares]


def _has_arm(wheel: Wheel, layout: Layout) -> bool:
    """Whether a joint is on a pulley's body beyond the pulley."""
    ends = [end for joint in layout.m.joints.values() for end in (joint.i, joint.j) if end.body.name == wheel.body]
    away = [math.dist(layout.place(end), (wheel.x, wheel.y)) for end in ends]
    return isinstance(wheel, Pulley) and max(away, default=0.0) + layout.sizes.hardware > wheel.root


def _rack(bars: list[Rack], name: str, marker: Marker, layout: Layout) -> Rack:
    (x, y), body = layout.place(marker), marker.body.name
    for rack in bars:
        same = rack.body == body and math.hypot(rack.x - x, rack.y - y) < SAME
        if same and abs(rack.angle - marker.angle) < 1e-9:
            return rack
    bars.append(Rack(name, body, x, y, marker.angle, []))
    return bars[-1]


def _least(marker: Marker, radius: float, m: Mechanism) -> float:
    """Least pitch radius (rmm) of a wheel: on a tube it is larger."""
    others = []
    for joint in m.joints.values():
        sized = with_radii(joint.params) if joint.kind.name in (GEARS, RACKS, BELTS) else {}
        ends = ((joint.i, "radius_i"), (joint.j, "radius_j"), (joint.j, "radius"))
        others += [sized[key] for end, key in ends if key in sized and end.body.name == marker.body.name]
    return wheels.LEAST_ON_TUBE if marker.body.name != "ground" and radius < max(others) * (1 - 1e-9) else wheels.LEAST
