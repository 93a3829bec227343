"""Gear pairs, gears with play, racks, belts: their wheels, racks and pulleys, in phase, on common layers.

Wheels that mesh share a layer. A wheel that is given by radii gets a standard module if that gives whole numbers of
teeth. A wheel that several joints name is one, unless its mates overlap: then it is an equal one in another layer.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mbsd.model.joint import Joint
from mbsd.model.teeth import with_radii
from mechanisms.stages.automatic.layout.extents import Extent, extent
from mechanisms.stages.automatic.layout.features import force_kind, kind
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.wheels import racks, wheels
from mechanisms.stages.automatic.wheels.belts import BELTS, belts
from mechanisms.stages.automatic.wheels.racks import Rack, add_way
from mechanisms.stages.automatic.wheels.sharing import enter
from mechanisms.stages.automatic.wheels.trains import Mesh, in_phase
from mechanisms.stages.automatic.wheels.wheels import Wheel
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.model.body import Marker
    from mbsd.model.force import Force
    from mechanisms.stages.automatic.layout.layout import Layout

GEARS, RACKS, PLAYING = "gear_pair", "rack_and_pinion", "gear_mesh"
SAME = 0.02
"""Wheels nearer than this (rmm) have one centre."""
TIP = 0.12
"""Height of teeth above the pitch circle where no module is given, at most, in radii of the smaller wheel."""
CENTRES = 0.02
"""How far the distance of two centres may be from that of their radii, as a part of it: the teeth still mesh."""


@extent(PLAYING)
@extent(GEARS)
def extent_of_gears(joint: Joint | Force, solution: Solution) -> Extent:
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
    return _gathered(m, layout)


@force_kind(PLAYING)
def gather_playing(m: Mechanism, forces: list[Force], layout: Layout) -> list[Feature]:
    """The same where gears with play are the first."""
    return _gathered(m, layout)


def _gathered(m: Mechanism, layout: Layout) -> list[Feature]:
    if any(layout.wheels.values()):
        return []
    known: list[Wheel] = []
    bars: list[Rack] = []
    meshes: list[Mesh] = []
    for joint in _toothed(m, layout):
        sized = with_radii(joint.params)
        if isinstance(joint, Joint) and joint.kind.name == RACKS:
            first = _rack(bars, joint.name, joint.i, layout)
            second = wheel_at(known, joint.name, joint.j, sized["radius"], False, layout)
            add_way(m, first, second, joint, layout)
        else:
            ring = bool(joint.params["internal"])
            first = wheel_at(known, joint.name, joint.i, sized["radius_i"], ring, layout)
            second = wheel_at(known, joint.name, joint.j, sized["radius_j"], False, layout)
            tip = layout.sizes.of_metres(joint.params.get("module") or TIP * min(sized["radius_i"], sized["radius_j"]))
            first, second = _apart(known, first, second, tip, layout), _apart(known, second, first, tip, layout)
            refuse_apart(m, joint, first, second, layout)
        first.mates.append(second)
        second.mates.append(first)
        meshes.append(Mesh(first, second, joint))
    in_phase(m, [*known, *bars], meshes, layout)
    bands = belts(m, layout)
    pulleys = [pulley for belt in bands for pulley in belt.pulleys]
    enter([*known, *pulleys], layout)
    for rack in bars:
        layout.extra.append(rack.layer)
    layout.meshing += [*(belt.pulleys for belt in bands), *((mesh.first, mesh.second) for mesh in meshes)]
    return [*known, *bars, *pulleys, *bands]


def _toothed(m: Mechanism, layout: Layout) -> list[Joint | Force]:
    """Gear pairs and racks, and gears with play, unless their bodies are left out."""
    with_play = [force for force in m.forces.values() if force.kind.name == PLAYING]
    return [
        *(joint for joint in m.joints.values() if joint.kind.name in (GEARS, RACKS)),
        *(force for force in with_play if not layout.apart.intersection(force.bodies)),
    ]


def _apart(known: list[Wheel], wheel: Wheel, mate: Wheel, tip: float, layout: Layout) -> Wheel:
    """The wheel, or an equal one in another layer where the mate would meet one that the wheel has already."""
    if wheel.ring or mate.ring or wheel.radius < wheels.LEAST_ON_TUBE:
        return wheel
    for candidate in known:
        same = math.hypot(candidate.x - wheel.x, candidate.y - wheel.y) < SAME and candidate.radius == wheel.radius
        if candidate.body != wheel.body or candidate.ring or not same:
            continue
        others = [
            other for other in candidate.mates if isinstance(other, Wheel) and not other.ring and other is not mate
        ]
        if not any(_meet(mate, other, tip, layout) for other in others):
            return candidate
    known.append(Wheel(f"{wheel.name}_{mate.body}", wheel.body, wheel.x, wheel.y, wheel.radius))
    return known[-1]


def _meet(first: Wheel, second: Wheel, tip: float, layout: Layout) -> bool:
    """Whether two wheels whose teeth are ``tip`` (rmm) high above their pitch circles meet in the plane."""
    away = layout.seen(second.body, (second.x, second.y), first.body) - (first.x, first.y)
    return bool(np.hypot(*away.T).min() < first.radius + second.radius + 2 * tip + layout.sizes.room)


def refuse_apart(m: Mechanism, joint: Joint | Force, first: Wheel, second: Wheel, layout: Layout) -> None:
    """Raises UserError unless the centres of two wheels stay as far apart as their radii require."""
    wanted = abs(first.radius - second.radius) if first.ring else first.radius + second.radius
    way = layout.seen(second.body, (second.x, second.y), first.body) - (first.x, first.y)
    apart = np.hypot(*way.T)
    if np.abs(apart - wanted).max() <= CENTRES * wanted:
        return
    scale = layout.sizes.scale
    raise UserError(
        f"{m.name}: {joint.kind.name} '{joint.name}': the centres of {first.body} and {second.body} are "
        f"{apart.min() * scale:.4g} to {apart.max() * scale:.4g} mm apart over the motion, where teeth of these radii "
        f"mesh at {wanted * scale:.4g} mm; hold them there by pins or an arm, or write {shown_file(m.name, 'parts')}"
    )


def wheel_at(known: list[Wheel], name: str, marker: Marker, radius: float, ring: bool, layout: Layout) -> Wheel:
    """The wheel of that pitch radius (m) about a marker: one of ``known``, or a new one that joins them."""
    (x, y), body, size = layout.place(marker), marker.body.name, layout.sizes.of_metres(radius)
    for wheel in known:
        same = wheel.body == body and math.hypot(wheel.x - x, wheel.y - y) < SAME and wheel.ring == ring
        if same and abs(wheel.radius - size) < 1e-6 * size:
            return wheel
    known.append(Wheel(name, body, x, y, size, ring))
    return known[-1]


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
    for joint in (*m.joints.values(), *m.forces.values()):
        sized = with_radii(joint.params) if joint.kind.name in (GEARS, RACKS, BELTS, PLAYING) else {}
        ends = ((joint.i, "radius_i"), (joint.j, "radius_j"), (joint.j, "radius"))
        others += [sized[key] for end, key in ends if key in sized and end.body.name == marker.body.name]
    return wheels.LEAST_ON_TUBE if marker.body.name != "ground" and radius < max(others) * (1 - 1e-9) else wheels.LEAST
