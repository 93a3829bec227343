"""Bodies that slide on ground, driven in several planes: a beam with clevises on two columns, as of a press (mm).

Along the columns, s is counted from the first pin of the beam, q to the left of that direction from the line of the
guide. The columns stand in a deck beyond the beam and end where it comes nearest to what drives it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.planar import Rounded, around
from mechanisms.stages.automatic.shafts.passing import Takes, box
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mechanisms.stages.automatic.shafts.bodies.kinds import Machine, Ram, RamPin
    from mechanisms.stages.automatic.shafts.thickness import Measures

BEAM, DECK, ABOVE = 14.0, 16.0, 6.0
"""Thickness of beam and deck along the columns, and what is between them at the beam's farthest place (rmm)."""
COLUMN, HUB = 6.0, 11.0
"""Radius of a column, and of what surrounds it in beam and deck (rmm)."""
CHEEK = 0.6
"""Thickness of the cheeks of a clevis, in that of a plate."""
ROOM = 2.0
"""From the eye of a link to the beam, and how far columns reach beyond the beam's nearest place (rmm)."""


@dataclass(frozen=True, eq=False)
class RamPlan:
    """A ram with its sizes."""

    ram: Ram
    unit: float
    eye: float
    """Radius of the cheeks round a pin."""
    clevises: tuple[tuple[RamPin, float, float, float], ...]
    """Each pin with half of the room for its link, and the outer faces of its cheeks along z."""

    reaches: tuple[float, ...]
    """How far from each pin its link reaches behind it."""

    @property
    def middle(self) -> float:
        """q of the columns."""
        return (min(pin.q for pin in self.ram.pins) + max(pin.q for pin in self.ram.pins)) / 2

    @property
    def half(self) -> float:
        """Half of the width of the beam."""
        return max(HUB * self.unit, max(abs(pin.q - self.middle) for pin in self.ram.pins) + self.eye)

    @property
    def low(self) -> float:
        """s of the beam's face on the side of the pins."""
        return max(pin.s + reach for pin, reach in zip(self.ram.pins, self.reaches, strict=True)) + ROOM * self.unit

    @property
    def high(self) -> float:
        """s of its other face."""
        return self.low + BEAM * self.unit

    @property
    def columns(self) -> tuple[float, float]:
        """Places of the columns along z."""
        return (
            min(low for _, _, low, _ in self.clevises) - HUB * self.unit,
            max(high for _, _, _, high in self.clevises) + HUB * self.unit,
        )

    @property
    def span(self) -> tuple[float, float]:
        """Span of the beam along z."""
        first, last = self.columns
        return first - HUB * self.unit, last + HUB * self.unit

    @property
    def deck(self) -> tuple[float, float]:
        """Both faces of the deck along the columns, from ``line``."""
        start = self.ram.farthest + self.high + ABOVE * self.unit
        return start, start + DECK * self.unit

    @property
    def begin(self) -> float:
        """Where the columns begin, from ``line``."""
        return self.ram.nearest + self.low - ROOM * self.unit

    @property
    def corners(self) -> list[tuple[float, float]]:
        """Corners of the deck's foot on the base plate."""
        (x, y), (u, v) = self.ram.line, self.ram.along
        wide = [self.middle + side * (self.half + HUB * self.unit) for side in (-1, 1)]
        return [(x + s * u - q * v, y + s * v + q * u) for s in self.deck for q in wide]

    def takes(self, low: float) -> list[Takes]:
        """Beam and clevises, and on ground columns and deck; ``low`` is the top of the base plate."""
        own, body = self.ram, self.ram.body
        links = frozenset(pin.link for pin in own.pins)
        u = math.cos(own.turn), math.sin(own.turn)
        beam = box(self.at(0.0, self.middle), u, self.low, self.high, self.half)
        spaces = [Takes(f"the beam of '{body}'", body, beam, *self.span)]
        for pin, _, bottom, top in self.clevises:
            cheek = around([self.at(pin.s, pin.q), self.at(self.low, pin.q)], self.eye)
            spaces.append(Takes(f"the clevis of '{pin.joint}'", body, cheek, bottom, top, links))
        r, rams = COLUMN * self.unit, frozenset([body])
        for z in self.columns:
            shape = self._on_ground(self.begin, self.deck[0], r)
            spaces.append(Takes(f"a column of '{body}'", "ground", shape, z - r, z + r, rams))
        deck = self._on_ground(*self.deck, self.half + HUB * self.unit)
        spaces.append(Takes(f"the deck of '{body}'", "ground", deck, low, self.span[1]))
        return spaces

    def _on_ground(self, low: float, high: float, half: float) -> Rounded:
        (x, y), (u, v) = self.ram.line, self.ram.along
        return box((x - self.middle * v, y + self.middle * u), self.ram.along, low, high, half)

    def at(self, s: float, q: float) -> tuple[float, float]:
        """A place in the frame of the body."""
        c, d = math.cos(self.ram.turn), math.sin(self.ram.turn)
        return self.ram.origin[0] + s * c - q * d, self.ram.origin[1] + s * d + q * c


def ram_plans(machine: Machine, measures: Measures, thickness: Mapping[str, float]) -> dict[str, RamPlan]:
    """By body. Raises UserError naming two links that leave no room for a cheek between them."""
    plans = {}
    cheek = CHEEK * measures.sizes.thickness * measures.unit
    for name, own in machine.rams.items():
        clevises = []
        for pin in own.pins:
            room = thickness[pin.link] / 2 + measures.axial
            clevises.append((pin, room, pin.z - room - cheek, pin.z + room + cheek))
        for (first, room, _, _), (second, more, _, _) in pairwise(clevises):
            apart, least = second.z - first.z, room + more + cheek
            if apart < least:
                raise UserError(
                    f"{machine.m.name}: '{first.link}' and '{second.link}' drive '{name}' {apart:.4g} mm apart along "
                    f"z, and the cheek between them needs {least:.4g} mm; move one of them along z, or make pins "
                    "thinner (automatic(m, pin=...))"
                )
        eye = measures.sizes.eye * measures.unit
        reaches = tuple(max(eye, measures.radius(machine.links[pin.link])) for pin in own.pins)
        plans[name] = RamPlan(own, measures.unit, eye, tuple(clevises), reaches)
    return plans
