"""Pins in straight slots: the plates with slots, pins that several slots share, and their solids."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import cadquery as cq
import numpy as np

from mbsd import Mechanism
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout import motion
from mechanisms.stages.automatic.layout.items import BASE, Anchor, Heights, Item, Levels, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan, build, kind
from mechanisms.stages.automatic.layout.planar import around, convex_hull, disc
from mechanisms.stages.automatic.pins.pin_solids import boss_height, holding_eye, standing
from mechanisms.stages.automatic.pins.pins import SAME, Pin
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.outline import band, loop
from shared.shapes.pin import Head, grooved, pin, washer
from shared.shapes.solid import Roll, Solid, placed
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# A pin that runs in several slots: one pin of its body, with a roller in each of them.
#
# A crank that moves two yokes, or indexes two Geneva wheels, has its slots on one side of it or on both.


def common(slot: Slot, layout: Layout) -> list[Slot]:
    """Return all through slots in which the pin of ``slot`` runs, this one among them."""
    every = (getattr(feature, "runs_through", None) for feature in layout.features)
    through = [other for other in every if isinstance(other, Slot)]
    return [other for other in through if other.pin == slot.pin and math.dist(other.pin_at, slot.pin_at) < SAME]


def passed(slot: Slot, layout: Layout) -> frozenset[str]:
    """Return names of the items that the pin passes through by design."""
    names = ((o.slot, f"the slotted plate of {o.name}", f"the wheel of {o.name}") for o in common(slot, layout))
    return frozenset(name for here in names for name in here)


def refuse_pins_of_both_kinds(m: Mechanism, features: Sequence[Feature]) -> None:
    """Raise UserError where a pin that runs in a slot is at the place of a revolute joint's pin."""
    pins = [feature for feature in features if isinstance(feature, Pin)]
    for slot in (getattr(feature, "runs_through", None) for feature in features):
        if slot is None:
            continue
        for other in pins:
            place = other.places.get(slot.pin)
            if place is not None and math.dist(place, slot.pin_at) < SAME:
                raise UserError(
                    f"{m.name}: the pin of joint '{slot.name}' is where {slot.pin} has that of joint '{other.name}'; "
                    f"give it a place of its own on {slot.pin}, or write {shown_file(m.name, 'parts')}"
                )


# Pin in slot: a pin of one body with a roller that runs in a slot of another.
#
# Either may be ground: a slot on ground is in a plate on two posts, which has a layer of its own; a pin on ground
# stands on a pedestal.

FAR = 6.0
"""Limits farther beyond the travel than it is long, or than this (diameters of a roller), end no slot."""
POST = 10.0
"""Diameter of the posts of a plate on ground (rmm)."""
FARTHER = 60.0
"""How much farther they may stand (rmm), so that a slide that carries the pin does not pass there."""
WALL = 7.0
"""Width of the plate beside the slot (rmm)."""


@dataclass(frozen=True, eq=False)
class Slot(Feature):
    """Places (rmm) of a pin on its body and of its slot on the other, as the way of the pin's middle."""

    name: str
    slot: str
    pin: str
    path: np.ndarray
    """(n, 2) in the frame of the slot's body; two places: a straight slot."""
    pin_at: tuple[float, float]

    @property
    def layer(self) -> str:
        """Name that decides the layer of the slot: its body, or its plate if the body is ground."""
        return self.slot if self.slot != "ground" else f"slot {self.name}"

    @property
    def runs_through(self) -> Slot | None:
        """The slot through which the pin goes; None where it ends in a groove."""
        return self

    @property
    def layers(self) -> tuple[str, ...]:
        """Layers of slot and pin, as far as these have one."""
        return (self.layer,) if self.pin == "ground" else (self.pin, self.layer)

    def radius(self, layout: Layout) -> float:
        """Return the radius of the plate round the slot's ends."""
        return layout.sizes.roller / 2 + WALL

    def posts(self, layout: Layout) -> list[tuple[float, float]]:
        """Return posts of a plate on ground: middles, beyond the two ends of the slot."""
        middles = []
        for end, other in ((self.path[0], self.path[-1]), (self.path[-1], self.path[0])):
            way = (end - other) / max(float(np.hypot(*(end - other))), 1e-9)
            x, y = end + (layout.sizes.roller / 2 + WALL + POST / 2 + FARTHER * layout.far_posts) * way
            middles.append((float(x), float(y)))
        return middles

    def outline(self, layout: Layout) -> list[tuple[float, float, float]]:
        """Return circles that a plate on ground goes round."""
        ends = [(x, y, POST / 2 + 2.0) for x, y in self.posts(layout)]
        return [*((float(x), float(y), self.radius(layout)) for x, y in self.path), *ends]

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return a wall round the slot, and an eye that holds the pin."""
        if self.slot == "ground":
            places = [Anchor("ground", x, y, POST / 2) for x, y in self.posts(layout)]
        else:
            places = [Anchor(self.slot, float(x), float(y), self.radius(layout)) for x, y in self.path]
        return [*places, Anchor(self.pin, *self.pin_at, layout.sizes.eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield the pin from its body, or the base, through the slot, and its head.

        Where the slot is on ground, its plate and posts follow.
        """
        shape, what = disc(*self.pin_at, layout.sizes.hardware), f"the pin of {self.name}"
        plate = f"the slotted plate of {self.name}"
        through = frozenset((self.slot, plate)) | passed(self, layout)
        reach = Reach(self.layers, 1, 1) if self.pin != "ground" else Reach(self.layers, high=1, base=True)
        stands = what if self.pin == "ground" else ""
        yield Item(what, self.pin, shape, reach, source=self, meshes=through, stands=stands)
        if self.slot == "ground":
            wide = self.radius(layout)
            shape = around([(x, y) for x, y, _ in self.outline(layout)], wide)
            meshes = frozenset((what,))
            yield Item(plate, "ground", shape, Reach((self.layer,)), source=self, meshes=meshes, stands=plate)
            for x, y in self.posts(layout):
                post = Reach((self.layer,), -1, -1, base=True)
                yield Item(f"a post of {plate}", "ground", disc(x, y, POST / 2 + 1.0), post, source=self, stands=plate)

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield what :meth:`needs_under` does, where the slot itself is a feature."""
        return self.needs_under(self, levels, layout)

    def needs_under(self, source: object, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room for a washer between the plates, and for the head of a pin from below.

        ``source`` is the feature that has the slot.
        """
        fit, pivot = layout.sizes.pivot.fit, layout.sizes.pivot
        low, high = min(levels[name] for name in self.layers), max(levels[name] for name in self.layers)
        if self.pin == "ground" and low == 0:
            yield Need(BASE, layout.sizes.pedestal + pivot.washer_room + fit.axial)
        elif high == low + 1:
            yield Need(low, pivot.washer_room + fit.axial)
        if layout.is_covered(source, 2 * (high + 1), levels, 1):
            yield Need(high, layout.sizes.head.height + 2 * fit.axial)


@kind("pin_in_slot")
def gather(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """Return one feature for each joint."""
    features: list[Feature] = []
    for joint in joints:
        slot, pin = joint.i.body.name, joint.j.body.name
        (x, y), way = layout.place(joint.i), np.array([math.cos(joint.i.angle), math.sin(joint.i.angle)])
        place = (layout.seen(pin, layout.place(joint.j), slot) - np.array([x, y])) @ way
        ends = np.array([x, y]) + np.outer(_ends(joint, m, (place.min(), place.max()), layout), way)
        features.append(entered(Slot(joint.name, slot, pin, ends, layout.place(joint.j)), layout))
    return features


def _ends(joint: Joint, m: Mechanism, travel: tuple[float, float], layout: Layout) -> tuple[float, float]:
    """Return ends of the roller's way in the slot (rmm): near limits, for the slot ends there."""
    lower, upper = (None if end is None else layout.sizes.of_metres(end) for end in motion.sliding(joint, m))
    lower, upper = motion.reached((lower, upper), travel, FAR * layout.sizes.roller)
    return travel[0] - 1.0 if lower is None else lower, travel[1] + 1.0 if upper is None else upper


def entered(slot: Slot, layout: Layout) -> Slot:
    """Return the slot with a layer of its own for a plate on ground."""
    if slot.slot == "ground":
        layout.extra.append(slot.layer)
    return slot


# The solids of a pin in a slot (rmm): the slot, its plate where that is on ground, the pin, its roller and washer.

GROOVES, GROOVE, GROOVE_DEPTH = 6, 2.6, 1.6
"""Grooves for oil in the face of a roller, by which one sees it turn: how many, width and depth (rmm)."""
RIM = 1.0
"""Between grooves and the rim of a large roller (rmm); in a small one they go through."""
SEEN = 2.0
"""How far the face of a large roller reaches beyond the head of its pin (rmm)."""
SMALL = Head(10.4, 3.2, 1.0)
"""Head of the pin of a small roller, whose face shows round it (rmm)."""
SMALL_GROOVE = 1.7
"""Width of the grooves of a small roller (rmm)."""
ROLLER_WALL = 0.4
"""Least wall of a roller (rmm)."""
PIECES = 24
"""About so many straight pieces stand for a curved slot."""
CHANNEL = 4.6
"""Depth of a slot that does not go through (rmm)."""


@build.register(Slot)
def slotted(slot: Slot, plan: Plan, heights: Heights) -> None:
    """Cut the slot, and put a pin with a roller through it: head on top from below, else hanging."""
    sizes = plan.layout.sizes
    tool = _tool(slot.path, (sizes.roller + sizes.pivot.fit.running) / 2, heights.thickness + 2.0).translate((0, 0, -1))
    if slot.slot == "ground":
        _plate(slot, tool, plan, heights)
    else:
        plan.cut(slot.slot, tool, 1)
        _keep_free(slot, plan)
    slot_pin(slot, plan, heights)


def _keep_free(slot: Slot, plan: Plan) -> None:
    """Tell the plate where its slot is, as straight pieces of it."""
    places = [(float(x), float(y)) for x, y in slot.path[:: max(1, len(slot.path) // PIECES)]]
    last = (float(slot.path[-1][0]), float(slot.path[-1][1]))
    kept = plan.slots.setdefault(slot.slot, [])
    kept += [[a, b] for a, b in pairwise([*places, last]) if a != b]


def _tool(path: np.ndarray, half: float, height: float) -> cq.Workplane:
    if len(path) == 2:
        return extruded(outline.hull([(float(x), float(y), half) for x, y in path]), height)
    return extruded(band(path, half), height)


def channelled(slot: Slot, plan: Plan, heights: Heights) -> None:
    """Cut a channel all round into the face where the pin comes from, and put a pin with a roller into it."""
    sizes = plan.layout.sizes
    half, low = (sizes.roller + sizes.pivot.fit.running) / 2, heights.bottom(slot.layer)
    below = slot.pin == "ground" or heights.bottom(slot.pin) < low
    tool = extruded(loop(slot.path, half), CHANNEL + 1.0, -1.0 if below else heights.thickness - CHANNEL)
    inner = extruded(loop(slot.path, -half), CHANNEL + 3.0, -2.0 if below else heights.thickness - CHANNEL - 1.0)
    tool = tool.cut(inner)
    if slot.slot == "ground":
        _plate(slot, tool, plan, heights, 0)
    else:
        plan.cut(slot.slot, tool, 0)
        _keep_free(slot, plan)
    slot_pin(slot, plan, heights, depth=CHANNEL)


def _plate(slot: Slot, tool: cq.Workplane, plan: Plan, heights: Heights, holes: int = 1) -> None:
    """On posts on the base."""
    seat, low = plan.layout.sizes.pivot.fit.seat, heights.bottom(slot.layer)
    wide = slot.radius(plan.layout)
    hull = convex_hull(np.array([(x, y) for x, y, _ in slot.outline(plan.layout)]), 1e-4)
    shape = extruded(outline.hull([(float(x), float(y), wide) for x, y in hull]), heights.thickness)
    shape = eased(shape, 0.6, ">Z", chamfer=True).cut(tool)
    plan.make("ground", f"slot_{slot.name}", placed(shape, z=low), "aluminium", holes)
    for k, (x, y) in enumerate(slot.posts(plan.layout), start=1):
        post = extruded(outline.circle(x, y, POST / 2), low - 2 * seat, seat)
        plan.make("ground", f"post_{slot.name}_{k}", post, "steel", 0)
        plan.feet.append(Foot("", x, y, POST / 2 + 2.0))


def slot_pin(
    slot: Slot, plan: Plan, heights: Heights, roller_diameter: float | None = None, depth: float | None = None
) -> None:
    """A pin with a roller at the height of the slot, on the pin's body: from below its head is on top.

    In a groove of a ``depth`` the pin ends. Through slots at one place of the body have one pin. With a
    ``roller_diameter`` of 0 the pin is bare.
    """
    through: list[Slot] = [slot] if roller_diameter is not None or depth is not None else common(slot, plan.layout)
    outer = plan.layout.sizes.roller if roller_diameter is None else roller_diameter
    large = outer > plan.layout.sizes.head.diameter + 2 * SEEN
    if outer > 0:
        _roller(slot, outer, large, depth, plan, heights)
    if slot.name == through[-1].name:
        _pin(through, large, depth, plan, heights)


def _is_below(slot: Slot, heights: Heights) -> bool:
    """Return True if the pin comes from below."""
    return slot.pin == "ground" or heights.bottom(slot.pin) < heights.bottom(slot.layer)


def _roller(slot: Slot, outer: float, large: bool, depth: float | None, plan: Plan, heights: Heights) -> None:
    pivot, (x, y) = plan.layout.sizes.pivot, slot.pin_at
    thick = (heights.thickness if depth is None else depth - 0.4) - 0.4
    bore = pivot.pin + pivot.fit.running
    turns = outer - bore >= 2 * ROLLER_WALL
    if not turns:  # of clockwork, whose clearances are wide beside its pins: it is pressed on
        bore = pivot.held
    if outer - bore < 2 * ROLLER_WALL:
        raise UserError(_no_wall(slot, outer, plan.layout))
    reach, width = (outer / 2 - RIM, GROOVE) if large else (outer, SMALL_GROOVE)
    roller = grooved(washer(bore, outer, thick, chamfer=0.4), GROOVES, reach, width, GROOVE_DEPTH)
    roll = Roll(slot.name, x, y, outer / 2, GROOVES) if turns else None
    below = _is_below(slot, heights)
    at = heights.bottom(slot.layer) + 0.2 if below else heights.top(slot.layer) - 0.2 - thick
    plan.add(slot.pin, Solid(f"roller_{slot.name}", placed(roller, x, y, at), "bronze", 1, rolls=roll))


def _no_wall(slot: Slot, outer: float, layout: Layout) -> str:
    scale, pin = layout.sizes.scale, layout.sizes.pivot.held
    return (
        f"{layout.m.name}: the roller of '{slot.name}' is {outer * scale:.3g} mm in diameter, and on a pin of "
        f"{layout.sizes.pin:g} mm it needs {(pin + 2 * ROLLER_WALL) * scale:.3g} mm or more; make it larger, the pins "
        f"thinner (automatic(m, pin=...)), or write {shown_file(layout.m.name, 'parts')}"
    )


def _pin(through: list[Slot], large: bool, depth: float | None, plan: Plan, heights: Heights) -> None:
    """Add the pin through all of its slots, from its body, with a boss and a washer on either side."""
    sizes = plan.layout.sizes
    pivot, fit, first = sizes.pivot, sizes.pivot.fit, through[0]
    body, (x, y) = first.pin, first.pin_at
    above = [(heights.bottom(slot.layer), heights.top(slot.layer)) for slot in through if _is_below(slot, heights)]
    under = [(heights.bottom(slot.layer), heights.top(slot.layer)) for slot in through if not _is_below(slot, heights)]
    head = None if depth is not None else SMALL if above and not large else sizes.head
    if above:
        end = max(high for _, high in above) + fit.axial if depth is None else above[0][0] + depth - 0.4
    else:
        end = heights.top(body) + (fit.seat if depth is None else -0.3)
    if body == "ground":
        height = min(low for low, _ in above) - fit.axial - pivot.washer_room
        standing(first.name, (x, y), height, plan, levels=heights.levels)
        plan.add("ground", pivot.washer_at(f"washer_{first.name}", x, y, height + fit.seat))
        start = 0.5
    else:
        over = min((low for low, _ in above), default=-math.inf) - heights.top(body)
        below = heights.bottom(body) - max((high for _, high in under), default=math.inf)
        rise, drop = (boss_height(gap - fit.axial - pivot.washer_room) for gap in (over, below))
        plan.eye(body, x, y, holding_eye(sizes, rise, drop))
        if above:
            plan.add(body, pivot.washer_at(f"washer_{first.name}", x, y, heights.top(body) + rise + fit.seat))
        if under:
            at = heights.bottom(body) - drop - pivot.washer_room
            plan.add(body, pivot.washer_at(f"washer_{first.name}", x, y, at))
        start = heights.bottom(body) + 0.3
        if under:
            start = min(low for low, _ in under) + 0.1 if depth is None else under[0][1] - depth + 0.4
    shape = pin(pivot.pin, end - start, head)
    plan.make(body, f"pin_{first.name}", placed(shape, x, y, start), "brass", 0)
