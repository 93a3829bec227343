"""What meshes with each other: one module, whole teeth, and phases so that a tooth stands in a space everywhere."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.wheels.racks import Rack
from mechanisms.stages.automatic.wheels.teeth import module_of
from mechanisms.stages.automatic.wheels.wheels import Wheel
from shared.shapes.involute import ADDENDUM, foul_inside, longest_rack_tip, longest_tip, shortest_tip
from shared.shapes.units import mm
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.model.force import Force
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Layout

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
    """Those that mesh with each other, directly or through others; a wheel comes first."""
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
    """Tip radius of a wheel, tip height of a rack: teeth are shorter where they would reach below a base circle."""
    if isinstance(gear, Rack):
        return min(ADDENDUM * gear.module, *(longest_rack_tip(pinion.radius) for pinion in gear.mates))
    wheels = [mate for mate in gear.mates if isinstance(mate, Wheel)]
    if gear.ring:
        return max(gear.radius - RING_TIP * gear.module, *(shortest_tip(gear.radius, mate.radius) for mate in wheels))
    longest = [longest_tip(gear.radius, mate.radius) for mate in wheels if not mate.ring]
    return min([gear.radius + ADDENDUM * gear.module, *longest])


def _mesh(m: Mechanism, train: list[Toothed], meshes: Sequence[Mesh], layout: Layout) -> None:
    """Phases from one to the next: where two touch, a tooth of one stands in a space of the other at the start."""
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
    """Angle of a tooth of ``mate`` in its body's frame (place along a rack), from that of the other."""
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
