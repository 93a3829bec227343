"""Pin in slot: a pin of one body with a roller that runs in a slot of another."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.automatic.features import Anchor, Feature, Need, kind
from mechanisms.automatic.items import Item, Reach
from mechanisms.automatic.planar import disc
from mechanisms.automatic.slot_solids import slotted

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.joint import Joint
    from mechanisms.automatic.heights import Heights
    from mechanisms.automatic.items import Levels
    from mechanisms.automatic.layout import Layout
    from mechanisms.automatic.plan import Plan

WALL = 7.0
"""Of the plate beside the slot (rmm)."""


@dataclass(frozen=True, eq=False)
class Slot:
    """Places (rmm) of the pin on its body, and of the slot and its direction (rad) on the other; the pin's travel in
    it.
    """

    name: str
    slot: str
    pin: str
    slot_at: tuple[float, float, float]
    pin_at: tuple[float, float]
    travel: tuple[float, float]

    def ends(self) -> list[tuple[float, float]]:
        """Middles of the slot's round ends, in its body's frame."""
        (x, y, angle), (low, high) = self.slot_at, self.travel
        return [(x + s * math.cos(angle), y + s * math.sin(angle)) for s in (low - 1.0, high + 1.0)]

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """A wall round the slot, and an eye that holds the pin."""
        radius = layout.sizes.roller / 2 + WALL
        return [
            *(Anchor(self.slot, x, y, radius) for x, y in self.ends()),
            Anchor(self.pin, *self.pin_at, layout.sizes.eye),
        ]

    def items(self, layout: Layout) -> Iterable[Item]:
        """The pin from its body through the slot, and its head."""
        shape = disc(*self.pin_at, layout.sizes.hardware)
        both = frozenset((self.slot, self.pin))
        return [Item(f"the pin of {self.name}", self.pin, shape, Reach((self.pin, self.slot), 1, 1), both, self)]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Room for a washer between the plates, and for the head above where the pin comes from below."""
        fit, pivot = layout.sizes.pivot.fit, layout.sizes.pivot
        low, high = sorted((levels[self.pin], levels[self.slot]))
        if high == low + 1:
            yield Need(low, pivot.washer_room + fit.axial)
        if layout.is_covered(self, 2 * (high + 1), levels):
            yield Need(high, layout.sizes.head.height + 2 * fit.axial)

    def build(self, plan: Plan, heights: Heights) -> None:
        """Slot, pin and roller."""
        slotted(self, plan, heights)


@kind("pin_in_slot")
def gather(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """One for each joint whose slot moves."""
    found: list[Feature] = []
    for joint in joints:
        slot, pin = joint.i.body.name, joint.j.body.name
        x, y = layout.place(joint.i)
        along = layout.seen(pin, layout.place(joint.j), slot) - np.array([x, y])
        place = along @ np.array([math.cos(joint.i.angle), math.sin(joint.i.angle)])
        travel = float(place.min()), float(place.max())
        found.append(Slot(joint.name, slot, pin, (x, y, joint.i.angle), layout.place(joint.j), travel))
    return found
