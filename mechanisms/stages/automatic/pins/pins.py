"""Pin joints: bolts, rods between pins, webs, and pins with play."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations, pairwise

import numpy as np

from mbsd import Mechanism, Solution
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout.items import (
    BASE,
    PIVOT,
    Anchor,
    Item,
    Levels,
    Need,
    PinReach,
    PivotReach,
    Reach,
)
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import force_kind, kind
from mechanisms.stages.automatic.layout.planar import disc
from mechanisms.stages.automatic.layout.sizes import ROD, Extent, extent
from shared.shapes.bodies import Place
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Rods: distance joints, and what is like a body here. A rod has an eye on the pin at either of its ends.
#
# In the model it is a constraint without mass, so it has no pose of its own: its frame is at the joint's first marker,
# and its x axis goes to the second.

LEAST = 22.0
"""Least length of a rod (rmm): that of a bar between two pins."""


def add_poses(layout: Layout) -> None:
    """Enter where each rod is over the motion."""
    for rod, joint in layout.rods.items():
        start, end = (layout.seen(marker.body.name, layout.place(marker), "ground") for marker in (joint.i, joint.j))
        way = end - start
        layout.poses[rod] = np.column_stack([start, np.unwrap(np.arctan2(way[:, 1], way[:, 0]))])


def ends(joint: Joint, layout: Layout) -> list[tuple[tuple[float, float], str, tuple[float, float]]]:
    """Return the place of either eye on the rod, the body that it is pinned to, and the place there (rmm)."""
    length = layout.sizes.of_metres(joint.params["length"])
    return [((x, 0.0), marker.body.name, layout.place(marker)) for x, marker in ((0.0, joint.i), (length, joint.j))]


def places(joint: Joint) -> tuple[Place, Place]:
    """Return the two places that the joint joins, in rmm."""
    first, second = ((marker.body.name, 1e3 * marker.x, 1e3 * marker.y) for marker in (joint.i, joint.j))
    return first, second


@extent(ROD)
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """Return an extent as long as a bar."""
    return Extent(least=((joint.params["length"], LEAST),))


# Revolute joints: links that turn about a common axis on one pin, with bushings, washers and circlip. Rods (above)
# turn about a pin at either end.
#
# Joints that share a place on a body share their pin. The lowest body holds it and its head is on top, or the highest
# holds it and it hangs down, kept by a circlip; on ground a pedestal holds it, or a bridge (bridges.py). Where
# something passes close above a pivot, its head is sunk into its link; a pin may join two webs of a crank (below).

LEAST_COLUMN = 2.5
"""Height of what carries a pivot over a wheel of ground (rmm)."""
SAME = 0.02
"""Places on a body that are nearer than this (rmm) are one."""


@dataclass(frozen=True, eq=False)
class Pin(Feature):
    """One axis: the place on each body that turns about it (rmm)."""

    name: str
    """Name of its first joint; a rod alone gives its name and that of the end, 1 or 2."""
    m: Mechanism
    places: dict[str, tuple[float, float]]
    webs: tuple[str, str] | None = None
    """Two plates of one body that it joins; all others on it turn between these."""
    play: float = 0.0
    """How far its axis is from that of its bushings at most (rmm): of a pin with clearance, and what that yields."""

    @cached_property
    def movers(self) -> tuple[str, ...]:
        """The bodies on it that move."""
        return tuple(body for body in self.places if body != "ground")

    @property
    def what(self) -> str:
        """Name of its item."""
        return f"the pivot {self.name} on ground" if self.on_ground else f"the pin of {self.name}"

    @property
    def on_ground(self) -> bool:
        """True if a pedestal or a bridge holds it."""
        return "ground" in self.places

    @property
    def home(self) -> str:
        """The body whose motion its axis is given in."""
        return "ground" if self.on_ground else self.movers[0]

    @property
    def choice(self) -> str:
        """0 if its lowest body holds it, 1 if its highest; on ground, 0 for the base and 1 for a bridge."""
        return f"pin {self.name}"

    @property
    def order(self) -> tuple[str, str, tuple[str, ...]] | None:
        """Its webs, and what is between them."""
        if self.webs is None:
            return None
        return *self.webs, tuple(body for body in self.movers if body not in self.webs)

    def is_flush(self, levels: Levels, layout: Layout) -> bool:
        """Return True if it ends in the plate of the one body on it, because something passes close above."""
        if not self._may_be_flush(layout) or levels[self.choice] == 1:
            return False
        return layout.is_covered(self, 2 * levels[self.movers[0]] + 1, levels)

    def _may_be_flush(self, layout: Layout) -> bool:
        if not layout.flush or not self.on_ground or len(self.movers) != 1 or layout.is_held(self):
            return False
        return all(getattr(feature, "slot", None) != self.movers[0] for feature in layout.features)  # pins run in slots

    @property
    def driven(self) -> bool:
        """True if a driver turns what is on it against ground."""
        drivers = self.m.drivers.values()
        return self.on_ground and any(d.kind.angular and set(d.bodies) <= set(self.places) for d in drivers)

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return an eye on every body."""
        return [Anchor(body, x, y, layout.sizes.eye) for body, (x, y) in self.places.items()]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Return all heights that pin and pedestal take."""
        x, y = self.places[self.home]
        shape, on_it = disc(x, y, layout.sizes.hardware), frozenset(self.places)
        if self.on_ground:
            reach = PivotReach(self.movers, self.choice, self.driven, self._may_be_flush(layout))
            return [Item(self.what, self.home, shape, reach, on_it, self, stands=PIVOT)]
        ends = PinReach(self.movers, self.choice) if self.webs is None else Reach(self.movers, 1, -1)
        return [Item(self.what, self.home, shape, ends, on_it, self)]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room for washers and flanges between neighbours, and for head or circlip on top."""
        sizes, pivot = layout.sizes, layout.sizes.pivot
        running = pivot.fit.axial + pivot.flange_room
        stack = sorted(levels[body] for body in self.movers)
        hangs = levels.get(self.choice) == 1
        held = {0, len(stack) - 2} if self.webs else {} if self.on_ground else {len(stack) - 2 if hangs else 0}
        for k, (low, high) in enumerate(pairwise(stack)):
            if high == low + 1:
                yield Need(low, pivot.washer_room + running * (1 if k in held else 2))
        top = stack[-1]
        if self.webs:
            return
        if hangs:
            if self.on_ground:
                yield Need(top, pivot.washer_room + running)
            if stack[0] == 0 or layout.is_covered(self, 2 * (stack[0] - 1), levels, -1):
                yield Need(stack[0] - 1, sizes.clip_room)
        elif not self.is_flush(levels, layout) and layout.is_covered(self, 2 * (top + 1), levels, 1):
            yield Need(top, sizes.clip_room if self.on_ground else sizes.end_room)
        wheel = layout.wheel_at(*self.places["ground"]) if self.on_ground and not hangs else None
        if wheel is not None and stack[0] == levels[wheel.layer] + 1:
            yield Need(levels[wheel.layer], LEAST_COLUMN + pivot.washer_room + running)
        if self.on_ground and not hangs and stack[0] == 0:
            yield Need(BASE, sizes.pedestal + pivot.washer_room + running)


def pins_on(layout: Layout, body: str) -> list[Pin]:
    """Return the pins that go through a body."""
    return [feature for feature in layout.select(Pin) if body in feature.places]


def pins_at(layout: Layout, body: str, place: tuple[float, float]) -> list[Pin]:
    """Return the pins at a place of a body (rmm)."""
    return [pin for pin in pins_on(layout, body) if math.dist(pin.places[body], place) < SAME]


@kind("revolute")
def gather(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """Return joints by their pins: those with a common place on a body are one."""
    return list(_pins(m, [*_named(joints, layout), *_rod_ends(layout)]))


def pins_of(layout: Layout) -> list[Pin]:
    """Return the pins of all revolute joints and rods of a layout, whether it has features or not."""
    revolute = [joint for joint in layout.m.joints.values() if joint.kind.name == "revolute"]
    return _pins(layout.m, [*_named(revolute, layout), *_rod_ends(layout)])


def _named(joints: list[Joint], layout: Layout) -> list[tuple[str, dict[str, tuple[float, float]]]]:
    return [(joint.name, {k.body.name: layout.place(k) for k in (joint.i, joint.j)}) for joint in joints]


@kind(ROD)
def gather_rods(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """Gather rods as features; their pins are those of the revolute joints, unless there are none."""
    revolute = [j for j in m.joints.values() if j.kind.pair == "pin" and not layout.apart.intersection(j.bodies)]
    return [] if revolute else list(_pins(m, _rod_ends(layout)))


def _rod_ends(layout: Layout) -> list[tuple[str, dict[str, tuple[float, float]]]]:
    """Return named ends, with the place on the rod and that on the body which it is pinned to."""
    return [
        (f"{rod}_{number}", {rod: own, body: place})
        for rod, joint in layout.rods.items()
        for number, (own, body, place) in enumerate(ends(joint, layout), start=1)
    ]


def _pins(m: Mechanism, named: list[tuple[str, dict[str, tuple[float, float]]]]) -> list[Pin]:
    """Return pins of named joints with a place on two bodies each: those with a common place are one pin."""
    ends = [at for _, at in named]
    group = list(range(len(named)))
    for j in range(len(named)):
        for i in range(j):
            shared = ends[i].keys() & ends[j].keys()
            if group[i] != group[j] and any(_same(ends[i][body], ends[j][body]) for body in shared):
                old, new = group[j], group[i]
                group = [new if g == old else g for g in group]
    pins: list[Pin] = []
    for g in dict.fromkeys(group):
        members = [k for k in range(len(named)) if group[k] == g]
        places = {body: place for k in members for body, place in ends[k].items()}
        pins.append(Pin(named[members[0]][0], m, places))
    return pins


def _same(a: tuple[float, float], b: tuple[float, float]) -> bool:
    return abs(a[0] - b[0]) < SAME and abs(a[1] - b[1]) < SAME


# Pins with play: the bushings of a clearance joint are bored as much wider as its journal moves in them.
#
# The play is what the motion shows, to scale: the clearance and what steel yields, so that nothing meets in the film.

THINNEST = 0.4
"""Least wall of a bushing (rmm)."""


@force_kind("clearance_joint")
def gather_with_play(m: Mechanism, forces: list[Force], layout: Layout) -> list[Feature]:
    """Return a pin each.

    Raises UserError where play leaves no bushing, or where another pin has the place.
    """
    pins: list[Feature] = []
    for force in forces:
        places = {marker.body.name: layout.place(marker) for marker in (force.i, force.j)}
        _refuse_shared(m, force, places, layout)
        pins.append(Pin(force.name, m, places, play=_play(m, force, layout)))
        layout.features.append(pins[-1])  # springs may end on it
    return pins


def _play(m: Mechanism, force: Force, layout: Layout) -> float:
    first, second = force.i, force.j
    away = layout.seen(second.body.name, layout.place(second), first.body.name) - layout.place(first)
    play = float(np.hypot(*away.T).max())
    pivot = layout.sizes.pivot
    most = (pivot.bushing - 2 * THINNEST - pivot.bored()) / 2
    if play > most:
        scale = layout.sizes.scale
        raise UserError(
            f"{m.name}: clearance joint '{force.name}' moves {play * scale:.3g} mm to a side, and bushings of "
            f"{pivot.bushing * scale:.3g} mm on a pin of {pivot.pin * scale:.3g} mm have room for {most * scale:.3g} "
            f"mm; give it less clearance, or write {shown_file(m.name, 'parts')}"
        )
    return play


def _refuse_shared(m: Mechanism, force: Force, places: dict[str, tuple[float, float]], layout: Layout) -> None:
    for body, place in places.items():
        for pin in pins_on(layout, body):
            if _same(place, pin.places[body]):
                raise UserError(
                    f"{m.name}: clearance joint '{force.name}' and '{pin.name}' are at one place of '{body}'; "
                    "bodies that share a pin have no play of their own in automatic parts; move one of them, or "
                    f"write {shown_file(m.name, 'parts')}"
                )


# Built-up cranks: a body of two plates, its webs, that the pin between them joins; a link turns on the pin.
#
# So a link passes a pivot of its own crank that no bar lets it pass, as on a crankshaft. All of a body that is no pin
# stays on the first web; pins are shared out.


def webbed(layout: Layout, bodies: Collection[str]) -> Iterable[Layout]:
    """Yield layouts in which one of ``bodies`` has a further web.

    Each of its pins is once the one that joins both, and the others are shared out in every way.
    """
    for body in (body for body in bodies if body in layout.bodies):
        pins = sorted(pins_on(layout, body), key=lambda pin: not pin.on_ground)
        free = [pin for pin in pins if not layout.is_held(pin)]
        for joining in free:
            if joining.on_ground or len(joining.places) < 2:
                continue
            rest = [pin for pin in pins if pin is not joining]
            more = any(a.body == body for f in layout.features if f not in pins for a in f.anchors(layout))
            moved = [pin for pin in (rest if more else rest[1:]) if pin in free]
            for count in range(1, len(moved) + 1):
                for chosen in combinations(moved, count):
                    yield _with_web(layout, body, joining, chosen)


def _with_web(layout: Layout, body: str, joining: Pin, chosen: Collection[Pin]) -> Layout:
    web = f"{body} 2"
    while web in layout.poses:
        web += "2"
    features = []
    for feature in layout.features:
        if feature is joining:
            places = {**joining.places, web: joining.places[body]}
            feature = replace(joining, places=places, webs=(body, web))
        elif isinstance(feature, Pin) and feature in chosen:
            feature = replace(feature, places={web if b == body else b: at for b, at in feature.places.items()})
        features.append(feature)
    poses = {**layout.poses, web: layout.poses[body]}
    return replace(layout, features=features, poses=poses, webs={**layout.webs, web: body})
