"""Pin in slot: a pin of one body with a roller that runs in a slot of another.

Either may be ground: a slot on ground is in a plate on two posts, which has a layer of its own; a pin on ground stands
on a pedestal.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout import limits
from mechanisms.stages.automatic.layout.features import kind
from mechanisms.stages.automatic.layout.items import BASE, Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.layout.planar import around, disc
from mechanisms.stages.automatic.slides.common_pins import passed

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout

FAR = 6.0
"""Limits farther beyond the travel than it is long, or than this (diameters of a roller), end no slot."""
POST = 10.0
"""Diameter of the posts of a plate on ground (rmm)."""
FARTHER = 60.0
"""How much farther they may stand (rmm), so that a slide that carries the pin does not pass there."""
WALL = 7.0
"""Width of the plate beside the slot (rmm)."""


@dataclass(frozen=True, eq=False)
class Slot:
    """Places (rmm) of the pin on its body, and of the slot on the other: the way of the pin's middle in it."""

    name: str
    slot: str
    pin: str
    path: np.ndarray
    """(n, 2) in the frame of the slot's body; two places: a straight slot."""
    pin_at: tuple[float, float]

    @property
    def layer(self) -> str:
        """What decides the layer of the slot: its body, or its plate where that is ground."""
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
        """Radius of the plate round the slot's ends."""
        return layout.sizes.roller / 2 + WALL

    def posts(self, layout: Layout) -> list[tuple[float, float]]:
        """Posts of a plate on ground: middles, beyond the two ends of the slot."""
        middles = []
        for end, other in ((self.path[0], self.path[-1]), (self.path[-1], self.path[0])):
            way = (end - other) / max(float(np.hypot(*(end - other))), 1e-9)
            x, y = end + (layout.sizes.roller / 2 + WALL + POST / 2 + FARTHER * layout.far_posts) * way
            middles.append((float(x), float(y)))
        return middles

    def outline(self, layout: Layout) -> list[tuple[float, float, float]]:
        """Circles that a plate on ground goes round."""
        ends = [(x, y, POST / 2 + 2.0) for x, y in self.posts(layout)]
        return [*((float(x), float(y), self.radius(layout)) for x, y in self.path), *ends]

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """A wall round the slot, and an eye that holds the pin."""
        if self.slot == "ground":
            places = [Anchor("ground", x, y, POST / 2) for x, y in self.posts(layout)]
        else:
            places = [Anchor(self.slot, float(x), float(y), self.radius(layout)) for x, y in self.path]
        return [*places, Anchor(self.pin, *self.pin_at, layout.sizes.eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """The pin from its body, or the base, through the slot, and its head; a plate on ground, with its posts."""
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
        """As :meth:`needs_under`, where the slot itself is a feature."""
        return self.needs_under(self, levels, layout)

    def needs_under(self, source: object, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Room for a washer between the plates, and for the head above where the pin comes from below; ``source`` is
        the feature that has the slot.
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
    """One for each joint."""
    features: list[Feature] = []
    for joint in joints:
        slot, pin = joint.i.body.name, joint.j.body.name
        (x, y), way = layout.place(joint.i), np.array([math.cos(joint.i.angle), math.sin(joint.i.angle)])
        place = (layout.seen(pin, layout.place(joint.j), slot) - np.array([x, y])) @ way
        ends = np.array([x, y]) + np.outer(_ends(joint, m, (place.min(), place.max()), layout), way)
        features.append(entered(Slot(joint.name, slot, pin, ends, layout.place(joint.j)), layout))
    return features


def _ends(joint: Joint, m: Mechanism, travel: tuple[float, float], layout: Layout) -> tuple[float, float]:
    """Ends of the way of the roller's middle in the slot (rmm): limits that are near, for the slot ends there."""
    lower, upper = (None if end is None else layout.sizes.of_metres(end) for end in limits.sliding(joint, m))
    lower, upper = limits.reached((lower, upper), travel, FAR * layout.sizes.roller)
    return travel[0] - 1.0 if lower is None else lower, travel[1] + 1.0 if upper is None else upper


def entered(slot: Slot, layout: Layout) -> Slot:
    """With a layer of its own for a plate on ground."""
    if slot.slot == "ground":
        layout.extra.append(slot.layer)
    return slot
