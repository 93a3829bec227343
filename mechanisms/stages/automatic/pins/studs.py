"""Ball studs that hold the ends of springs: in a body's plate, on a post on ground, or on the end of a joint's pin."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.features import Anchor, Feature, Need
from mechanisms.stages.automatic.layout.items import Item, Reach
from mechanisms.stages.automatic.layout.planar import disc
from mechanisms.stages.automatic.pins.pins import SAME, Pin
from mechanisms.stages.automatic.pins.stud_solids import EYE, FOOT, POST, stud_in_plate, stud_on_pin, stud_on_post

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.heights import Heights
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.plan import Plan
    from mechanisms.stages.automatic.pins.springs import Stretching


@dataclass(frozen=True, eq=False)
class Stud:
    """One place of a body (rmm) and the ends (0 or 1) that it holds; ``pin`` where a joint's pin is there."""

    body: str
    x: float
    y: float
    ends: tuple[tuple[Stretching, int], ...]
    pin: Pin | None

    @property
    def name(self) -> str:
        """Of its first end."""
        one, end = self.ends[0]
        return f"{one.force}_{end + 1}"

    @property
    def what(self) -> str:
        """What its item is called."""
        return f"the stud {self.name}"

    @property
    def layers(self) -> tuple[str, ...]:
        """Of all that it holds."""
        return tuple(dict.fromkeys(one.layer for one, _ in self.ends))

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """An eye in the plate, or the foot of a post."""
        if self.pin is not None:
            return []
        return [Anchor(self.body, self.x, self.y, FOOT if self.body == "ground" else EYE)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """All between its body, or its pin, and what it holds; and that this lies over it."""
        held = frozenset(one.names[1] for one, _ in self.ends)
        if self.pin is not None:
            under = Reach(self.pin.movers, high=1, base=True)
            reach, spares = Reach((*self.pin.movers, *self.layers), 1, -1), frozenset(self.pin.places)
        elif self.body == "ground":
            under, reach, spares = None, Reach(self.layers, -1, -1, base=True), frozenset[str]()
        else:
            under = Reach((self.body,), base=True) if layout.springs.above else None
            reach, spares = Reach((self.body, *self.layers), 1, -1), frozenset[str]()
        yield Item(self.what, self.body, disc(self.x, self.y, POST), reach, spares, self)
        if under is not None:
            yield Item(f"{self.what} from below", self.body, disc(self.x, self.y, EYE), under, spares, self, only=held)

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Nothing beside what springs and pins need."""
        return []

    def build(self, plan: Plan, heights: Heights) -> None:
        """A stud with a ball at the height of each end."""
        if self.pin is not None:
            stud_on_pin(self, self.pin, plan, heights)
        elif self.body == "ground":
            stud_on_post(self, plan, heights)
        else:
            stud_in_plate(self, plan, heights)


def studs(found: Sequence[Stretching], layout: Layout) -> list[Feature]:
    """Ends that share a place of a body, or a pin, share a stud."""
    pins = [feature for feature in layout.features if isinstance(feature, Pin)]
    places: list[tuple[str, float, float, Pin | None, list[tuple[Stretching, int]]]] = []
    for one in found:
        for k, (body, x, y) in enumerate(one.ends):
            pin = next((p for p in pins if body in p.places and math.dist(p.places[body], (x, y)) < SAME), None)
            if pin is not None:
                body, (x, y) = pin.home, pin.places[pin.home]
            for place in places:
                if place[0] == body and math.dist(place[1:3], (x, y)) < SAME:
                    place[4].append((one, k))
                    break
            else:
                places.append((body, x, y, pin, [(one, k)]))
    return [Stud(body, x, y, tuple(ends), pin) for body, x, y, pin, ends in places]
