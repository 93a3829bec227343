"""Rams that slide on columns: their plan and their solids (mm)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import cadquery as cq

from mechanisms.stages.automatic.layout.planar import Rounded, around, box
from mechanisms.stages.automatic.shafts.bodies import Machine, Ram, RamPin
from mechanisms.stages.automatic.shafts.passing import Takes
from mechanisms.stages.automatic.shafts.shaft_plan import Measures
from mechanisms.stages.automatic.shafts.valves import along_x
from shared.shapes.build import extruded
from shared.shapes.kernel import through_holes
from shared.shapes.outline import circle
from shared.shapes.solid import Solid, placed
from shared.stage.errors import UserError

# Bodies that slide on ground, driven in several planes: a beam with clevises on two columns, as of a press (mm).
#
# Along the columns, s is counted from the first pin of the beam, q to the left of that direction from the line of the
# guide. The columns stand in a deck beyond the beam and end where it comes nearest to what drives it.

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
        """Return the beam and clevises, and on ground columns and deck; ``low`` is the top of the base plate."""
        own, body = self.ram, self.ram.body
        links = frozenset(pin.link for pin in own.pins)
        u = math.cos(own.turn), math.sin(own.turn)
        beam = box(self.place(0.0, self.middle), u, self.low, self.high, self.half)
        spaces = [Takes(f"the beam of '{body}'", body, beam, *self.span)]
        for pin, _, bottom, top in self.clevises:
            cheek = around([self.place(pin.s, pin.q), self.place(self.low, pin.q)], self.eye)
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

    def place(self, s: float, q: float) -> tuple[float, float]:
        """Return a place in the frame of the body."""
        c, d = math.cos(self.ram.turn), math.sin(self.ram.turn)
        return self.ram.origin[0] + s * c - q * d, self.ram.origin[1] + s * d + q * c


def ram_plans(machine: Machine, measures: Measures, thickness: Mapping[str, float]) -> dict[str, RamPlan]:
    """Return ram plans by body.

    Raises UserError naming two links that leave no room for a cheek between them.
    """
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


# A ram with its clevises and pins, and on ground its columns and the deck in which they stand (mm).

SEAT = 0.02


def ram_solids(own: RamPlan, pin: float, material: str) -> list[Solid]:
    """Return the ram, its main piece first, and its pins of radius ``pin``."""
    first, last = own.span
    shape = _box(own.low, own.high, own.middle, own.half, first, last)
    for clevis, room, bottom, top in own.clevises:
        for low, high in ((bottom, clevis.z - room), (clevis.z + room, top)):
            cheek = extruded(circle(clevis.s, clevis.q, own.eye), high - low, low)
            shape = shape.union(cheek).union(_box(clevis.s, own.low + 1.0, clevis.q, own.eye, low, high))
    for clevis, _, bottom, top in own.clevises:
        shape = shape.cut(extruded(circle(clevis.s, clevis.q, pin + SEAT), top - bottom + 2, bottom - 1))
    running = max(0.12, 0.02 * own.unit)
    for z in own.columns:
        shape = shape.cut(_column(own, own.low - 1, own.high + 1, z, COLUMN * own.unit + running))
    solids = [Solid(own.ram.body, _on_body(own, shape), material, through_holes(shape))]
    for s, q, bottom, top in _merged(own):
        bolt = extruded(circle(s, q, pin), top - bottom, bottom)
        solids.append(Solid(f"pin_{own.ram.body}", _on_body(own, bolt), "brass", 0))
    return solids


def guide_solids(own: RamPlan, low: float) -> list[Solid]:
    """Return columns and deck, from the base plate (z = ``low``) up."""
    begin, (below, above) = own.begin, own.deck
    wide = own.half + HUB * own.unit
    deck = _box(below, above, own.middle, wide, low, own.span[1])
    solids = []
    for k, z in enumerate(own.columns, start=1):
        column = _column(own, begin, above, z, COLUMN * own.unit)
        deck = deck.cut(_column(own, below - 1, above + 1, z, COLUMN * own.unit + SEAT))
        solids.append(Solid(f"column_{own.ram.body}_{k}", _on_ground(own, column), "steel", 0))
    solids.append(Solid(f"deck_{own.ram.body}", _on_ground(own, deck), "aluminium_blue", through_holes(deck)))
    return solids


def _merged(own: RamPlan) -> list[tuple[float, float, float, float]]:
    """Return the place and ends of the pins: one through clevises of one place whose cheeks touch."""
    merged: list[tuple[float, float, float, float]] = []
    for clevis, _, bottom, top in own.clevises:
        for k, (s, q, low, high) in enumerate(merged):
            if math.hypot(s - clevis.s, q - clevis.q) < SEAT and bottom < high + SEAT:
                merged[k] = (s, q, low, max(high, top))
                break
        else:
            merged.append((clevis.s, clevis.q, bottom, top))
    return merged


def _box(x0: float, x1: float, y: float, half: float, z0: float, z1: float) -> cq.Workplane:
    box = cq.Workplane().box(x1 - x0, 2 * half, z1 - z0, centered=(False, True, False))
    return box.translate((x0, y, z0))


def _column(own: RamPlan, begin: float, end: float, z: float, radius: float) -> cq.Workplane:
    return along_x(extruded(circle(0, 0, radius), end - begin, begin)).translate((0, own.middle, z))


def _on_body(own: RamPlan, shape: cq.Workplane) -> cq.Workplane:
    return placed(shape, *own.ram.origin, turn=math.degrees(own.ram.turn))


def _on_ground(own: RamPlan, shape: cq.Workplane) -> cq.Workplane:
    u, v = own.ram.along
    return placed(shape, *own.ram.line, turn=math.degrees(math.atan2(v, u)))
