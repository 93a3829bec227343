"""Gear pairs: wheels with involute teeth on the bodies' own layer, in phase where they mesh; rings as annuli.

Wheels that mesh share a layer. A wheel that is given by radii gets a standard module if that gives whole numbers of
teeth."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from mbsd.teeth import with_radii
from mechanisms.automatic.extents import Extent, extent
from mechanisms.automatic.features import Anchor, Feature, Need, kind
from mechanisms.automatic.gear_solids import build_wheel
from mechanisms.automatic.items import Item, Reach
from mechanisms.automatic.planar import Rounded, disc
from mechanisms.automatic.teeth import module_of
from shared.errors import UserError
from shared.shapes.involute import ADDENDUM, DEDENDUM, longest_tip, shortest_tip
from shared.shapes.units import mm

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.joint import Joint
    from mechanisms.automatic.heights import Heights
    from mechanisms.automatic.items import Levels
    from mechanisms.automatic.layout import Layout
    from mechanisms.automatic.plan import Plan

SECTORS = 36
"""Pieces of an annulus in the plane."""
RIM = 6.0
"""Of a ring gear outside its teeth (rmm)."""


@dataclass(eq=False)
class Wheel:
    """One wheel (rmm, rad in its body's frame)."""

    name: str
    body: str
    x: float
    y: float
    radius: float
    ring: bool
    teeth: int = 0
    module: float = 0.0
    tip: float = 0.0
    play: float = 0.0
    phase: float | None = None
    mates: list[Wheel] = field(default_factory=list)

    @property
    def layer(self) -> str:
        """What decides its layer: its body, or itself where that is ground."""
        return self.body if self.body != "ground" else self.what

    @property
    def what(self) -> str:
        """In messages."""
        return f"the {'ring' if self.ring else 'wheel'} of {self.body} at {self.name}"

    @property
    def root(self) -> float:
        """Radius where its teeth begin."""
        return self.radius + (DEDENDUM if self.ring else -DEDENDUM) * self.module

    @property
    def outside(self) -> float:
        """Its outer radius."""
        return self.root + RIM if self.ring else self.tip

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """None: the wheel is no part of the outline."""
        return [Anchor("ground", self.x, self.y, self.outside)] if self.body == "ground" else []

    def items(self, layout: Layout) -> Iterable[Item]:
        """A disc, or an annulus in pieces."""
        reach, spares = Reach((self.layer,)), frozenset[str]()
        meshes = frozenset(mate.what for mate in self.mates)
        if not self.ring:
            yield Item(self.what, self.body, disc(self.x, self.y, self.tip), reach, spares, self, meshes)
            if self.body == "ground":
                post = disc(self.x, self.y, self.root - 1.0)
                yield Item(self.what, self.body, post, Reach((self.layer,), -1, -1, base=True), spares, self, meshes)
            return
        middle, half = (self.outside + self.tip) / 2, (self.outside - self.tip) / 2
        angles = np.linspace(0, 2 * np.pi, SECTORS + 1)
        places = np.column_stack([self.x + middle * np.cos(angles), self.y + middle * np.sin(angles)])
        for a, b in pairwise(places):
            yield Item(self.what, self.body, Rounded(np.array([a, b]), half), reach, spares, self, meshes)
        if self.body == "ground":
            for x, y in self.posts():
                reach = Reach((self.layer,), -1, -1, base=True)
                yield Item(f"a post of {self.what}", self.body, disc(x, y, RIM), reach, spares, self, meshes)

    def posts(self) -> list[tuple[float, float]]:
        """Of a ring that is fixed to ground, under its rim."""
        at = self.outside - RIM / 2
        angles = [math.radians(degrees) for degrees in (45, 135, 225, 315)]
        return [(self.x + at * math.cos(a), self.y + at * math.sin(a)) for a in angles]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """None."""
        return []

    def build(self, plan: Plan, heights: Heights) -> None:
        """The wheel as its body's plate, or as a piece that stands on ground."""
        build_wheel(self, plan, heights)


LEAST = 15.2
"""Least pitch radius (rmm): a pin and its flanges stay inside of its teeth."""


@extent("gear_pair")
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """Both wheels."""
    sized = with_radii(joint.params)
    first, second = sized["radius_i"], sized["radius_j"]
    return Extent(((joint.i, first), (joint.j, second)), ((min(first, second), LEAST),))


@kind("gear_pair")
def gather(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """All wheels of the mechanism, in phase."""
    wheels: list[Wheel] = []
    pairs: list[tuple[Wheel, Wheel, Joint]] = []
    for joint in joints:
        sized = with_radii(joint.params)
        internal = bool(joint.params["internal"])
        first = _wheel(wheels, joint.name, joint.i, sized["radius_i"], internal, layout)
        second = _wheel(wheels, joint.name, joint.j, sized["radius_j"], False, layout)
        first.mates.append(second)
        second.mates.append(first)
        pairs.append((first, second, joint))
    for train in _trains(wheels):
        _count(m, train, pairs, layout)
        _mesh(m, train, pairs, layout)
    for wheel in wheels:
        layout.wheels.setdefault(wheel.body, []).append(wheel)
        if wheel.body == "ground":
            layout.extra.append(wheel.layer)
        layout.together += [(wheel.layer, mate.layer) for mate in wheel.mates]
    _refuse_what_has_no_shape(m, layout)
    return list(wheels)


def _wheel(wheels: list[Wheel], name: str, marker, radius: float, ring: bool, layout: Layout) -> Wheel:
    (x, y), body, size = layout.place(marker), marker.body.name, layout.sizes.of_metres(radius)
    for wheel in wheels:
        same = wheel.body == body and math.hypot(wheel.x - x, wheel.y - y) < 0.02 and wheel.ring == ring
        if same and abs(wheel.radius - size) < 1e-6 * size:
            return wheel
    wheels.append(Wheel(name, body, x, y, size, ring))
    return wheels[-1]


def _trains(wheels: list[Wheel]) -> list[list[Wheel]]:
    """Wheels that mesh with each other, directly or through others."""
    found: list[list[Wheel]] = []
    seen: set[int] = set()
    for start in wheels:
        train, waiting = [], [start]
        while waiting:
            wheel = waiting.pop(0)
            if id(wheel) not in seen:
                seen.add(id(wheel))
                train.append(wheel)
                waiting += wheel.mates
        if train:
            found.append(train)
    return found


def _count(m: Mechanism, train: list[Wheel], pairs: list[tuple[Wheel, Wheel, Joint]], layout: Layout) -> None:
    """Module, teeth, play and tips of a train."""
    scale = layout.sizes.scale
    given = [j.params["module"] for a, _, j in pairs if a in train and j.params.get("teeth") is not None]
    module = mm(given[0]) if given else module_of([wheel.radius * scale for wheel in train])
    if module is None:
        radii = ", ".join(f"{wheel.body} {wheel.radius * scale:.4g} mm" for wheel in train)
        raise UserError(
            f"{m.name}: gears with pitch radii {radii} have no whole numbers of teeth with one module; choose radii in "
            "a ratio of small whole numbers, or give teeth= and module="
        )
    play = max(0.22, 0.06 * module)
    for wheel in train:
        wheel.module = module / scale
        wheel.teeth = round(2 * wheel.radius / wheel.module)
        wheel.play = play / scale
    for wheel in train:
        tip = wheel.radius + (-0.9 if wheel.ring else ADDENDUM) * wheel.module
        for mate in wheel.mates:
            if wheel.ring:
                tip = max(tip, shortest_tip(wheel.radius, mate.radius))
            elif not mate.ring:
                tip = min(tip, longest_tip(wheel.radius, mate.radius))
        wheel.tip = tip


def _mesh(m: Mechanism, train: list[Wheel], pairs: list[tuple[Wheel, Wheel, Joint]], layout: Layout) -> None:
    """Phases from wheel to wheel: where two touch, a tooth of one stands in a space of the other at the start."""
    train[0].phase = 0.0
    waiting = [train[0]]
    while waiting:
        wheel = waiting.pop(0)
        for first, second, joint in pairs:
            if wheel not in (first, second):
                continue
            mate = second if wheel is first else first
            phase = _phase_of(wheel, mate, layout)
            if mate.phase is None:
                mate.phase = phase
                waiting.append(mate)
                continue
            pitch = 2 * math.pi / mate.teeth
            off = abs((mate.phase - phase + pitch / 2) % pitch - pitch / 2)
            if off > 0.02 * pitch:
                raise UserError(
                    f"{m.name}: gear_pair '{joint.name}': the teeth of {mate.body} and {wheel.body} miss each other by "
                    f"{100 * off / pitch:.0f} % of a pitch where the others mesh; space equal planets so that the "
                    "teeth of sun and ring together divide by their number, or change the numbers of teeth"
                )


def _phase_of(wheel: Wheel, mate: Wheel, layout: Layout) -> float:
    """Angle of a tooth of ``mate`` in its body's frame, from that of ``wheel``."""
    centres, turns = [], []
    for one in (wheel, mate):
        x, y, turn = layout.poses[one.body][0]
        c, s = math.cos(turn), math.sin(turn)
        centres.append((x + c * one.x - s * one.y, y + s * one.x + c * one.y))
        turns.append(turn)
    to_mate = math.atan2(centres[1][1] - centres[0][1], centres[1][0] - centres[0][0])
    # direction of the point of contact from either centre
    own = to_mate + (math.pi if mate.ring else 0.0)
    other = own if wheel.ring or mate.ring else to_mate + math.pi
    way = (wheel.phase or 0.0) + turns[0] - own
    sign = 1.0 if wheel.ring or mate.ring else -1.0
    return (sign * way * wheel.radius + math.pi * wheel.module / 2) / mate.radius + other - turns[1]


def _refuse_what_has_no_shape(m: Mechanism, layout: Layout) -> None:
    for body, wheels in layout.wheels.items():
        if body != "ground" and any(wheel.ring for wheel in wheels):
            raise UserError(
                f"{m.name}: the ring gear of '{body}' turns, and such rings have no parts by themselves yet; fix it to "
                f"ground and let the carrier turn, or write mechanisms/{m.name}/parts.py"
            )
        if body != "ground" and len(wheels) > 1:
            raise UserError(
                f"{m.name}: '{body}' has {len(wheels)} different wheels, and stepped gears have no parts by themselves "
                f"yet; write mechanisms/{m.name}/parts.py, or weld two bodies with a wheel each"
            )
