"""The layout in the plane: poses, features and outlines of all bodies, and items that take room."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from mbsd import Marker, Mechanism
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout.items import (
    BASE,
    PIVOT,
    Anchor,
    Heights,
    Item,
    Levels,
    Need,
    PinReach,
    Reach,
    span,
    spans_meet,
)
from mechanisms.stages.automatic.layout.layers import Problem
from mechanisms.stages.automatic.layout.planar import Rounded, around, core_gaps, least_gap, placed
from mechanisms.stages.automatic.layout.sizes import Sizes, rods_of


@dataclass(frozen=True)
class Springs:
    """Springs that get parts, and where they lie."""

    above: bool = True
    """True if they have to lie over both of their bodies."""
    left_out: frozenset[str] = frozenset()
    names: list[str] = field(default_factory=list, compare=False)
    """Names of the others, once features are gathered."""


class Feature:
    """One joint, or several that are one thing such as links on a common pin. By itself it takes no room."""

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return where outlines of bodies must reach."""
        return ()

    def items(self, layout: Layout) -> Iterable[Item]:
        """Return the items that take room besides the bodies' own plates."""
        return ()

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Return how high gaps must be, once the layers are known."""
        return ()

    def build(self, plan: Any, heights: Heights) -> None:
        """Give eyes to the bodies and solids to the ``plan`` (plan.Plan), where a feature has solids."""


class Layered(Protocol):
    """An element with a layer."""

    @property
    def layer(self) -> str:
        """Name that decides the layer: that of the body, or its own."""
        ...


class Carrier(Layered, Protocol):
    """A wheel, as far as the outline of its body and its plate ask."""

    body: str
    x: float
    y: float
    ring: bool
    shares: bool

    @property
    def root(self) -> float:
        """Radius where its teeth begin (rmm)."""
        ...


@dataclass(eq=False)
class Layout:
    """A mechanism in reference millimetres: poses over the motion, features, outlines and what takes room."""

    m: Mechanism
    sizes: Sizes
    poses: dict[str, np.ndarray]
    """By body, (T, 3): x, y (rmm) and theta (rad)."""
    times: np.ndarray
    springs: Springs = field(default_factory=lambda: Springs())
    wheels: dict[str, list[Carrier]] = field(default_factory=dict)
    """By body; set before outlines are asked for."""
    meshing: list[tuple[Layered, Layered]] = field(default_factory=list)
    """Wheels, racks and pulleys that share a layer because they mesh or have one belt."""
    extra: list[str] = field(default_factory=list)
    """Layers that are no body's and no wheel's: racks, slots, springs."""
    together: list[tuple[str, str]] = field(default_factory=list)
    """Pairs that share a layer."""
    features: list[Feature] = field(default_factory=list)
    apart: frozenset[str] = frozenset()
    """Bodies that get no solids from here."""
    touching: frozenset[frozenset[str]] = frozenset()
    """Pairs of bodies that may touch by design; a feature adds those of its own when it is gathered."""
    pressing: set[frozenset[str]] = field(default_factory=set)
    """Such pairs that are bolted to each other: the order of layers keeps all else of them apart."""
    yielding: set[frozenset[str]] = field(default_factory=set)
    """Pairs of bodies whose round part is seen to press into a wall: these two pieces touch, and nothing else."""
    flush: bool = False
    """True if pivots on ground may end flush with the one link that turns on them."""
    tubes: bool = False
    """True if there are wheels on tubes because arms would meet their mates."""
    far_posts: bool = False
    """True if slotted plates on ground reach farther to their posts."""
    webs: dict[str, str] = field(default_factory=dict)
    """Further plates of bodies, by name, each with its body."""
    rounds: dict[tuple[str, float, float], Feature] = field(default_factory=dict)
    """By body and place: balls, wheels and discs, which several contacts may share."""
    known_gaps: dict[tuple[Hashable, ...], tuple[float, int]] = field(default_factory=dict, repr=False)
    """Gaps by what they follow from, for layouts that differ in some features alone and share these."""

    def place(self, marker: Marker) -> tuple[float, float]:
        """Return a marker in its body's frame (rmm)."""
        return self.sizes.of_metres(marker.x), self.sizes.of_metres(marker.y)

    def seen(self, body: str, place: tuple[float, float], other: str) -> np.ndarray:
        """Return (T, 2) a place of ``body`` in the frame of another body over the motion (rmm)."""
        frame = self.poses[other]
        x, y = (placed(np.array([place]), self.poses[body])[:, 0] - frame[:, :2]).T
        c, s = np.cos(frame[:, 2]), np.sin(frame[:, 2])
        return np.stack([c * x + s * y, c * y - s * x], axis=1)

    @cached_property
    def anchors(self) -> dict[str, list[Anchor]]:
        """By moving body, without repeats; the largest radius where two are at one place."""
        by_body: dict[str, list[Anchor]] = {name: [] for name in self.moving}
        for feature in self.features:
            for anchor in feature.anchors(self):
                places = by_body.get(anchor.body)
                if places is None:
                    continue
                same = [i for i, a in enumerate(places) if np.hypot(a.x - anchor.x, a.y - anchor.y) < 0.01]
                if not same:
                    places.append(anchor)
                elif anchor.radius > places[same[0]].radius:
                    places[same[0]] = anchor
        return {body: [a for a in places if not self._on_wheel(a)] for body, places in by_body.items()}

    def wheel_at(self, x: float, y: float) -> Carrier | None:
        """Return the wheel of ground about a place on it (rmm): what turns there stands on that wheel."""
        here = [wheel for wheel in self.wheels.get("ground", []) if math.hypot(wheel.x - x, wheel.y - y) < 0.02]
        return next((wheel for wheel in here if not wheel.ring), None)

    def _on_wheel(self, anchor: Anchor) -> bool:
        """Return True if the wheel in its body's layer carries it."""
        reach = min(anchor.radius, self.sizes.hardware)
        wheels = [wheel for wheel in self.wheels.get(anchor.body, []) if wheel.shares and not wheel.ring]
        return any(math.hypot(anchor.x - w.x, anchor.y - w.y) + reach <= w.root for w in wheels)

    @property
    def layered(self) -> list[str]:
        """All that gets a layer."""
        wheels = [wheel for here in self.wheels.values() for wheel in here]
        return [*self.moving, *(wheel.layer for wheel in wheels if wheel.layer != wheel.body), *self.extra]

    @cached_property
    def rods(self) -> dict[str, Joint]:
        """Joints that are rods, by the names of these; they move as bodies do."""
        return rods_of(self.m, self.apart)

    @cached_property
    def bodies(self) -> list[str]:
        """Names of the bodies that move and are not left out."""
        return [name for name in self.m.bodies if name != "ground" and name not in self.apart]

    @cached_property
    def moving(self) -> list[str]:
        """The bodies, rods and webs that need a layer."""
        return [*self.bodies, *self.rods, *self.webs]

    def outline(self, body: str) -> Rounded:
        """Return the shape that holds a body's plate."""
        anchors = self.anchors[body]
        radius = max(anchor.radius for anchor in anchors)
        return around([(anchor.x, anchor.y) for anchor in anchors], radius)

    @cached_property
    def items(self) -> list[Item]:
        """Plates of the bodies first, in their order, then all that features add."""
        plates = [Item(name, name, self.outline(name), Reach((name,))) for name in self.moving if self.anchors[name]]
        return plates + [item for feature in self.features for item in feature.items(self)]

    @cached_property
    def conflicts(self) -> list[tuple[int, int]]:
        """Pairs of items of different bodies that meet in the plane at some time: they need different heights."""
        items, pairs = self.items, []
        circles = [item.shape.reach for item in items]
        radii = np.array([radius for _, radius in circles])
        middles = [placed(c, self.poses[item.body])[:, 0] for (c, _), item in zip(circles, items, strict=True)]
        for j, second in enumerate(items):
            may = [i for i, first in enumerate(items[:j]) if self.may_meet(first, second)]
            for i in may:
                apart = float(((middles[i] - middles[j]) ** 2).sum(axis=1).min()) ** 0.5
                if apart - radii[i] - radii[j] < self.sizes.room and self.gap(items[i], second)[0] < self.sizes.room:
                    pairs.append((i, j))
        return pairs

    def problem(self, fixed: Mapping[str, int] | None = None, hanging: frozenset[str] = frozenset()) -> Problem:
        """Return the problem that the search for layers solves."""
        between = [feature.order for feature in self.features if getattr(feature, "order", None)]
        together = [*self.together, *((wheel.layer, mate.layer) for wheel, mate in self.meshing)]
        return Problem(self.layered, self.items, self.conflicts, fixed or {}, together, hanging, between)

    def with_flush_pivots(self) -> Layout:
        """Return the same with pivots that may be flush, and with all that was found of meetings.

        Such pivots meet the same in the plane.
        """
        flushed = replace(self, flush=True, features=list(self.features))
        flushed.__dict__["conflicts"] = self.conflicts
        return flushed

    def with_far_posts(self) -> Layout:
        """Return the same with flush pivots, and posts of slotted plates out of the way of carried pins."""
        return replace(self, flush=True, far_posts=True, features=list(self.features))

    def select[F](self, kind: type[F]) -> list[F]:
        """Return the features of one kind, in their order."""
        return [feature for feature in self.features if isinstance(feature, kind)]

    def is_held(self, pin: object) -> bool:
        """Return True if something stands on a pin."""
        return any(getattr(feature, "pin", None) is pin for feature in self.features)

    def gap(self, first: Item, second: Item) -> tuple[float, float]:
        """Return the least gap in the plane (rmm), and its time (s)."""
        key = first.body, first.shape.content, second.body, second.shape.content
        if key not in self.known_gaps:
            poses = self.poses[first.body], self.poses[second.body]
            self.known_gaps[key] = least_gap(first.shape, second.shape, poses, self.sizes.room)
        gap, at = self.known_gaps[key]
        return gap, float(self.times[at])

    def may_meet(self, first: Item, second: Item) -> bool:
        """Return True if two items that meet in the plane need different heights: no pair by design."""
        if first.body == second.body == "ground":
            return bool(first.stands and second.stands) and first.stands != second.stands
        if first.body == second.body:
            return self._are_stepped(first, second) or self._are_stepped(second, first)
        return not (
            first.what in second.meshes
            or second.what in first.meshes
            or (first.only and second.what not in first.only)
            or (second.only and first.what not in second.only)
            or (first.spared and first.body in second.spares)
            or (second.spared and second.body in first.spares)
            or frozenset(self.webs.get(item.body, item.body) for item in (first, second)) in self.touching
        )

    def _are_stepped(self, first: Item, second: Item) -> bool:
        """Return True if the first is a wheel on a tube that the second must pass.

        The second is its body's plate, another wheel of it, or a pin beside.
        """
        wheels = [wheel for wheel in self.wheels.get(first.body, []) if not wheel.ring]
        if not any(wheel is first.source and wheel.layer == first.what for wheel in wheels):
            return False
        if isinstance(second.reach, PinReach):
            return second.what not in first.meshes
        return second.what == second.body or any(w is second.source and w is not first.source for w in wheels)

    def is_covered(self, source: object, half_layer: int, levels: Levels, further: int = 0) -> bool:
        """Return True if something at a half layer meets an item of the feature ``source`` in the plane.

        Up to ``further`` half layers from there count, too: what ends in the gap beyond an empty layer may reach into
        that layer.
        """
        mine = {k for k, item in enumerate(self.items) if item.source is source}
        others = {j if i in mine else i for i, j in self.conflicts if (i in mine) != (j in mine)}
        looked = min(half_layer, half_layer + further), max(half_layer, half_layer + further)
        return any(spans_meet(span(self.items[k].reach, levels), looked) for k in others)

    def room_below(self, x: float, y: float, levels: Levels) -> float:
        """Return the distance (rmm) from a place on ground to what moves below the lowest layer."""
        here, every = np.full((len(self.times), 1, 2), (x, y)), np.arange(len(self.times))
        moving = (i for i in self.items if i.body != "ground" and not i.only and i.what != i.body)
        low = (i for i in moving if spans_meet(span(i.reach, levels), (BASE, BASE)))
        gaps = (core_gaps(here, placed(i.shape.core_at(every), self.poses[i.body])) - i.shape.radius for i in low)
        return min((float(gap.min()) for gap in gaps), default=math.inf)

    def room_on_base(self, x: float, y: float) -> float:
        """Return half of the distance (rmm) from a place on ground to the next thing that stands there."""
        places = [a for feature in self.features for a in feature.anchors(self) if a.body == "ground"]
        away = [math.hypot(a.x - x, a.y - y) for a in places]
        half = min((d for d in away if d > 0.01), default=math.inf) / 2
        wide = [item.shape for item in self.items if item.stands and item.stands != PIVOT and item.body == "ground"]
        here = np.array([[[x, y]]])
        gaps = [float(core_gaps(here, shape.core[None])[0]) - shape.radius for shape in wide if len(shape.core) > 1]
        return min([half, *(gap for gap in gaps if gap > 0)])
