"""Gear pairs and trains: numbers of teeth, layers that wheels share, and the joints with them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise

import numpy as np

from mbsd import Mechanism, Solution
from mbsd.model.body import Marker
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.teeth import with_radii
from mechanisms.stages.automatic.layout.items import Item, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import FORCE_KINDS, contact_kind, force_kind, kind
from mechanisms.stages.automatic.layout.sizes import Extent, extent
from mechanisms.stages.automatic.pins.pins import SAME
from mechanisms.stages.automatic.wheels import racks, wheels
from mechanisms.stages.automatic.wheels.cables import SLACK_SPANS, SPANS, cables
from mechanisms.stages.automatic.wheels.pulleys import BELTS, Belt, Pulley, belts
from mechanisms.stages.automatic.wheels.racks import Rack, add_way
from mechanisms.stages.automatic.wheels.wheels import LEAST_ON_TUBE, Wheel
from shared.shapes.involute import ADDENDUM, foul_inside, longest_rack_tip, longest_tip, shortest_tip
from shared.shapes.units import mm
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# The wheel that lies in its body's layer: the largest, unless something else is in the way.
#
# A cam, a wheel on a road or a Geneva wheel fills its body's layer: what touches it would meet the teeth. An arm does
# so only where it meets the mates; then thinner pins are tried first. All other wheels lie in layers of their own, on
# tubes.


def enter(wheels: Sequence[Wheel], layout: Layout) -> None:
    """Enter the wheels by their bodies; of each body the largest lies in its layer.

    Not so where a ring's bottom or, of pulleys, an arm does: a belt would run through that.
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
    """Return the layout with wheels on tubes where their body's layer has no room.

    All features must be known. ``beside_arms``: also where an arm is in the way of their mates.
    """
    wheels = [wheel for wheel in layout.select(Wheel) if wheel.body != "ground" and wheel.shares]
    wide = [wheel for wheel in wheels if wheel.radius >= LEAST_ON_TUBE]
    filled = {getattr(feature, "fills", "") for feature in layout.features}
    beside = [wheel for wheel in wide if wheel.body not in filled and beside_arms and _meets_an_arm(wheel, layout)]
    moved = [wheel for wheel in wide if wheel.body in filled or wheel in beside]
    for wheel in moved:
        wheel.shares = False
    return replace(layout, tubes=bool(beside)) if moved else layout


def _meets_an_arm(wheel: Wheel, layout: Layout) -> bool:
    """Return True if its mates, or its belt, meet what else its body has in its layer."""
    mates: list[object] = [*wheel.mates]
    mates += [belt for belt in layout.select(Belt) if wheel in belt.pulleys]
    near = [item for item in layout.items if item.source in mates and item.body != wheel.body]
    own = [item for item in layout.items if item.body == wheel.body and item.source is not wheel]
    own = [item for item in own if _is_always_in(item, wheel.body)]
    return any(layout.may_meet(a, b) and layout.gap(a, b)[0] < layout.sizes.room for a in own for b in near)


def _is_always_in(item: Item, layer: str) -> bool:
    reach = item.reach
    return isinstance(reach, Reach) and layer in reach.bodies and reach.low <= 0 <= reach.high


def _has_arm(wheel: Wheel, layout: Layout) -> bool:
    """Return True if a joint, spring, traced point or bar's end is on a pulley's body beyond it."""
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


# Numbers of teeth and the module of wheels that are given by pitch radii: a standard module if one fits.

STANDARD = (0.05, 0.06, 0.08, 0.1, 0.12, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6, 8)
STANDARD += (10, 12, 16, 20, 25, 32, 40, 50)
"""Modules (mm) of ISO 54, first choice."""
WISH = 18
"""Teeth that the smallest wheel gets, about."""
FEWEST, MOST = 8, 400


def module_of(radii: Sequence[float]) -> float | None:
    """Return the module (mm) for wheels that mesh with each other, from their pitch radii (mm).

    It is a standard one if that gives whole numbers of teeth, else the one that gives them nearest to :data:`WISH`;
    None where the radii allow no whole numbers.
    """
    smallest, largest = min(radii), max(radii)
    fitting = [m for m in STANDARD if all(_whole(2 * radius / m) for radius in radii)]
    fitting = [m for m in fitting if 2 * smallest / m >= FEWEST and 2 * largest / m <= MOST]
    wished = 2 * smallest / WISH
    if fitting:
        return min(fitting, key=lambda m: abs(math.log(m / wished)))
    parts = [Fraction(radius / smallest).limit_denominator(60) for radius in radii]
    if any(abs(float(part) * smallest - radius) > 1e-6 * radius for part, radius in zip(parts, radii, strict=True)):
        return None
    least = math.lcm(*(part.denominator for part in parts))
    count = least * max(1, round(WISH / least))
    return 2 * smallest / count if count * largest / smallest <= MOST else None


def _whole(number: float) -> bool:
    return abs(number - round(number)) < 1e-6 * number


# Wheels that mesh: one module, whole teeth, and phases so that a tooth stands in a space everywhere.

type Toothed = Wheel | Rack

RING_TIP = 0.9
"""Height of a ring's teeth inside the pitch circle, in modules."""
LESS = 8
"""Teeth that a pinion has less than its ring gear, so that their tips do not cross: enough for 12 to 200 teeth."""
MISS = 0.02
"""Part of a pitch by which teeth may miss each other."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Two that mesh: of a ring or a rack it is the first."""

    first: Toothed
    second: Wheel
    joint: Joint | Force


def in_phase(m: Mechanism, toothed: Sequence[Toothed], meshes: Sequence[Mesh], layout: Layout) -> None:
    """Give all their teeth. Raises UserError where there are no whole ones, or where they miss each other."""
    for train in _trains(toothed):
        _count(m, train, [mesh for mesh in meshes if mesh.second in train], layout)
        _mesh(m, train, meshes, layout)


def _trains(toothed: Sequence[Toothed]) -> list[list[Toothed]]:
    """Return groups of wheels that mesh with each other, directly or through others; a wheel comes first."""
    trains: list[list[Toothed]] = []
    seen: set[int] = set()
    for start in sorted(toothed, key=lambda gear: isinstance(gear, Rack)):
        train: list[Toothed] = []
        waiting: list[Toothed] = [start]
        while waiting:
            gear = waiting.pop(0)
            if id(gear) not in seen:
                seen.add(id(gear))
                train.append(gear)
                waiting += [mate for mate in gear.mates if isinstance(mate, Wheel | Rack)]
        if train:
            trains.append(train)
    return trains


def _count(m: Mechanism, train: list[Toothed], meshes: Sequence[Mesh], layout: Layout) -> None:
    """Module, teeth, play and tips of a train."""
    scale = layout.sizes.finished
    wheels = [wheel for wheel in train if isinstance(wheel, Wheel)]
    given = [mesh.joint.params["module"] for mesh in meshes if mesh.joint.params.get("teeth") is not None]
    module = mm(given[0]) * layout.sizes.ratio if given else module_of([wheel.radius * scale for wheel in wheels])
    if module is None:
        radii = ", ".join(f"{wheel.body} {wheel.radius * scale:.4g} mm" for wheel in wheels)
        raise UserError(
            f"{m.name}: gears with pitch radii {radii} have no whole numbers of teeth with one module; choose radii in "
            "a ratio of small whole numbers, or give teeth= and module="
        )
    within = [mesh.joint.params.get("backlash", 0.0) for mesh in meshes]
    play = max(0.22, 0.06 * module) + mm(max(within, default=0.0)) * layout.sizes.ratio
    for gear in train:
        gear.module, gear.play = module / scale, play / scale
    for wheel in wheels:
        wheel.teeth = round(2 * wheel.radius / wheel.module)
    for gear in train:
        gear.tip = _tip(gear)
    for mesh in meshes:
        _refuse_foul(m, mesh)


def _refuse_foul(m: Mechanism, mesh: Mesh) -> None:
    """Raises UserError where a pinion has too many teeth for its ring gear."""
    ring, pinion = mesh.first, mesh.second
    if isinstance(ring, Wheel) and ring.ring and foul_inside(pinion.radius, pinion.tip, ring.radius, ring.tip):
        raise UserError(
            f"{m.name}: {mesh.joint.kind.name} '{mesh.joint.name}': the tips of {pinion.body} with {pinion.teeth} "
            f"teeth cross those of the ring gear of {ring.body} with {ring.teeth} away from where they mesh; give the "
            f"pinion at least {LESS} teeth less than the ring, or write {shown_file(m.name, 'parts')}"
        )


def _tip(gear: Toothed) -> float:
    """Return the tip radius of a wheel, or the tip height of a rack.

    Teeth are shorter where they would reach below a base circle.
    """
    if isinstance(gear, Rack):
        return min(ADDENDUM * gear.module, *(longest_rack_tip(pinion.radius) for pinion in gear.mates))
    wheels = [mate for mate in gear.mates if isinstance(mate, Wheel)]
    if gear.ring:
        return max(gear.radius - RING_TIP * gear.module, *(shortest_tip(gear.radius, mate.radius) for mate in wheels))
    longest = [longest_tip(gear.radius, mate.radius) for mate in wheels if not mate.ring]
    return min([gear.radius + ADDENDUM * gear.module, *longest])


def _mesh(m: Mechanism, train: list[Toothed], meshes: Sequence[Mesh], layout: Layout) -> None:
    """Set phases one after the other: where two touch, a tooth of one stands in a space of the other."""
    train[0].phase = 0.0
    waiting = [train[0]]
    while waiting:
        gear = waiting.pop(0)
        for mesh in meshes:
            if gear is not mesh.first and gear is not mesh.second:
                continue
            mate = mesh.second if gear is mesh.first else mesh.first
            phase = _phase_of(gear, mate, layout)
            if mate.phase is None:
                mate.phase = phase
                waiting.append(mate)
                continue
            pitch = mate.pitch
            off = abs((mate.phase - phase + pitch / 2) % pitch - pitch / 2)
            if off > MISS * pitch:
                raise UserError(
                    f"{m.name}: {mesh.joint.kind.name} '{mesh.joint.name}': the teeth of {mate.body} and {gear.body} "
                    f"miss each other by {100 * off / pitch:.0f} % of a pitch where the others mesh; space equal "
                    "planets so that the teeth of sun and ring together divide by their number, or change the numbers "
                    "of teeth"
                )


def _phase_of(gear: Toothed, mate: Toothed, layout: Layout) -> float:
    """Return the angle of a tooth of ``mate`` in its frame (along a rack its place) from the other's."""
    if isinstance(mate, Rack) and isinstance(gear, Wheel):
        along, turn = mate.sees(gear, layout)
        return along + gear.radius * ((gear.phase or 0.0) + turn + math.pi / 2) + math.pi * gear.module / 2
    if isinstance(gear, Rack) and isinstance(mate, Wheel):
        along, turn = gear.sees(mate, layout)
        return ((gear.phase or 0.0) - math.pi * gear.module / 2 - along) / mate.radius - math.pi / 2 - turn
    if isinstance(gear, Rack) or isinstance(mate, Rack):
        raise TypeError("racks mesh with wheels")
    return _phase_of_wheel(gear, mate, layout)


def _phase_of_wheel(wheel: Wheel, mate: Wheel, layout: Layout) -> float:
    centres, turns = [], []
    for gear in (wheel, mate):
        x, y, turn = layout.poses[gear.body][0]
        c, s = math.cos(turn), math.sin(turn)
        centres.append((x + c * gear.x - s * gear.y, y + s * gear.x + c * gear.y))
        turns.append(turn)
    to_mate = math.atan2(centres[1][1] - centres[0][1], centres[1][0] - centres[0][0])
    # direction of the point of contact from either centre
    own = to_mate + (math.pi if mate.ring else 0.0)
    other = own if wheel.ring or mate.ring else to_mate + math.pi
    way = (wheel.phase or 0.0) + turns[0] - own
    sign = 1.0 if wheel.ring or mate.ring else -1.0
    return (sign * way * wheel.radius + math.pi * wheel.module / 2) / mate.radius + other - turns[1]


# Gear pairs, gears with play, racks, belts: their wheels, racks and pulleys, in phase, on common layers.
#
# Wheels that mesh share a layer. A wheel that is given by radii gets a standard module if that gives whole numbers of
# teeth. A wheel that several joints name is one, unless its mates overlap: then it is an equal one in another layer.

GEARS, RACKS, PLAYING = "gear_pair", "rack_and_pinion", "gear_mesh"
TIP = 0.12
"""Height of teeth above the pitch circle where no module is given, at most, in radii of the smaller wheel."""
CENTRES = 0.02
"""How far the distance of two centres may be from that of their radii, as a part of it: the teeth still mesh."""


@extent(PLAYING)
@extent(GEARS)
def extent_of_gears(joint: Joint | Force, solution: Solution) -> Extent:
    """Return both wheels; smaller ones of a stepped gear have room for the tube they sit on."""
    sized = with_radii(joint.params)
    both = (joint.i, sized["radius_i"]), (joint.j, sized["radius_j"])
    least = tuple((radius, _least(marker, radius, solution.mechanism)) for marker, radius in both)
    return Extent(both, least)


@extent(RACKS)
def extent_of_rack(joint: Joint, solution: Solution) -> Extent:
    """Return the pinion."""
    radius = with_radii(joint.params)["radius"]
    return Extent(((joint.j, radius),), ((radius, racks.LEAST),))


@kind(BELTS)
@kind(SPANS)
@contact_kind(SLACK_SPANS)
@kind(RACKS)
@kind(GEARS)
@force_kind(PLAYING)
def gather(m: Mechanism, things: Sequence[Joint | Force], layout: Layout) -> list[Feature]:
    """Return all wheels, racks and pulleys of the mechanism, in phase, at the first of these kinds."""
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
    bands, ropes = belts(m, layout), cables(m, layout)
    pulleys = [pulley for line in (*bands, *ropes) for pulley in line.pulleys]
    enter([*known, *pulleys], layout)
    for rack in bars:
        layout.extra.append(rack.layer)
    layout.meshing += [*(belt.pulleys for belt in bands), *((mesh.first, mesh.second) for mesh in meshes)]
    layout.meshing += [pair for rope in ropes for pair in pairwise(rope.pulleys)]
    return [*known, *bars, *pulleys, *bands, *(feature for rope in ropes for feature in (*rope.studs(layout), rope))]


def _toothed(m: Mechanism, layout: Layout) -> list[Joint | Force]:
    """Return the gear pairs and racks, and gears with play, unless their bodies are left out."""
    with_play = [force for force in m.forces.values() if force.kind.name == PLAYING]
    return [
        *(joint for joint in m.joints.values() if joint.kind.name in (GEARS, RACKS)),
        *(force for force in with_play if not layout.apart.intersection(force.bodies)),
    ]


def _apart(known: list[Wheel], wheel: Wheel, mate: Wheel, tip: float, layout: Layout) -> Wheel:
    """Return the wheel, or an equal one in another layer where mates of the wheel would meet."""
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
    """Return True if two wheels meet whose teeth are ``tip`` (rmm) high above their pitch circles."""
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
    """Return the wheel of that pitch radius (m) about a marker, of ``known`` or a new one that joins them."""
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
    """Return the least pitch radius (rmm) of a wheel: on a tube it is larger."""
    others = []
    for joint in (*m.joints.values(), *m.forces.values()):
        sized = with_radii(joint.params) if joint.kind.name in (GEARS, RACKS, BELTS, PLAYING) else {}
        ends = ((joint.i, "radius_i"), (joint.j, "radius_j"), (joint.j, "radius"))
        others += [sized[key] for end, key in ends if key in sized and end.body.name == marker.body.name]
    return wheels.LEAST_ON_TUBE if marker.body.name != "ground" and radius < max(others) * (1 - 1e-9) else wheels.LEAST
