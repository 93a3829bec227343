"""Where a shaft has its crank pins, webs and journals along the normal (mm)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from shared.stage.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mechanisms.stages.automatic.shafts.cylinders import Cylinder
    from mechanisms.stages.automatic.shafts.machine import Shaft, Throw
    from mechanisms.stages.automatic.shafts.thickness import Measures

WEB, LEAST_WEB = 0.22, 0.09
"""Thickness of a web, wished and least, in bores."""
SHARE = 0.27
"""Of the space between two crank pins, what each of two webs gets."""
LEAST_BEARING = 0.16
END = 0.34
"""Lengths of journals, in bores: between two throws at least, and at either end."""
JOURNAL = 1.1
"""Radius of the journals in that of the crank pins."""
NECK = 1.1
"""Radius of a web about the axis, in that of the journals."""
CHEEK = 1.3
"""Radius of a web round its crank pin in that of the pin."""
SNOUT, FLANGE = 0.3, 0.12
"""Lengths beyond the journals at the upper and at the lower end, in bores."""
SAME = 1e-3


@dataclass(frozen=True)
class Pin:
    """A crank pin with all links on it, from ``low`` to ``high``."""

    x: float
    y: float
    low: float
    high: float
    links: tuple[str, ...]


@dataclass(frozen=True)
class Web:
    """From ``low`` to ``high``, between the axis and the pins at its two faces; ``weight``: with a counterweight."""

    low: float
    high: float
    pins: tuple[tuple[float, float], ...]
    weight: bool


@dataclass(frozen=True)
class Journal:
    """A part that turns in a bearing on ground."""

    low: float
    high: float


@dataclass(frozen=True, eq=False)
class ShaftPlan:
    """All of one shaft, in its own frame about its axis."""

    shaft: Shaft
    unit: float
    """The bore that it goes with."""
    pin: float
    """Radius of its crank pins."""
    pins: tuple[Pin, ...]
    webs: tuple[Web, ...]
    journals: tuple[Journal, ...]
    gap: float
    """Along the axis, beside what turns on it or in what it turns."""
    counterweight: float
    """The largest radius of a counterweight."""

    @property
    def journal(self) -> float:
        """Radius of its journals."""
        return JOURNAL * self.pin

    @property
    def cheek(self) -> float:
        """Radius of a web round a crank pin."""
        return CHEEK * self.pin

    @property
    def has_weights(self) -> bool:
        """Whether there is room for counterweights."""
        return self.counterweight > 1.15 * self.neck

    @property
    def neck(self) -> float:
        """Radius of a web about the axis."""
        return NECK * self.journal

    @property
    def swept(self) -> float:
        """What its webs sweep about the axis, and a counterweight at most."""
        reach = max((math.hypot(pin.x, pin.y) for pin in self.pins), default=0.0) + self.cheek
        return max(reach, self.counterweight if self.has_weights else 0.0, self.journal)

    @property
    def ends(self) -> tuple[float, float]:
        """Of all journals along z."""
        return self.journals[0].low, self.journals[-1].high

    @property
    def top(self) -> float:
        """Highest z of the shaft."""
        return self.ends[1] + SNOUT * self.unit

    def bottom(self, flywheel: float) -> float:
        """Lowest z of the shaft; ``flywheel`` is the radius of its flywheel, 0 for none."""
        return self.ends[0] - (2.2 if flywheel else 1.0) * FLANGE * self.unit


def shaft_plan(
    shaft: Shaft, measures: Measures, thickness: Mapping[str, float], cylinders: Mapping[str, Cylinder]
) -> ShaftPlan:
    """Plan a shaft. Raises UserError naming two links that are too near along z for a web between them."""
    unit, gap = measures.of_shaft(shaft), measures.axial
    pins = _pins(shaft, thickness, gap, _both(unit))
    webs, journals = _between(measures, shaft, pins, unit)
    thick = webs[0].high - webs[0].low
    first, last = pins[0].low - thick, pins[-1].high + thick
    webs = [Web(first, pins[0].low, ((pins[0].x, pins[0].y),), True), *webs[1:-1]]
    webs.append(Web(pins[-1].high, last, ((pins[-1].x, pins[-1].y),), True))
    journals = [Journal(first - END * unit, first), *journals, Journal(last, last + END * unit)]
    own = [one.counterweight for one in cylinders.values() if one.shaft is shaft]
    reach = max(math.hypot(pin.x, pin.y) for pin in pins) + CHEEK * measures.crank_pin(shaft)
    weight = min([*own, 1.05 * reach])
    return ShaftPlan(shaft, unit, measures.crank_pin(shaft), tuple(pins), tuple(webs), tuple(journals), gap, weight)


def _pins(shaft: Shaft, thickness: Mapping[str, float], gap: float, most: float) -> list[Pin]:
    """Links at one place that follow each other along z share a pin, where less than ``most`` is between them."""
    groups: list[list[Throw]] = []
    for throw in shaft.throws:
        last = groups[-1][-1] if groups else None
        between = throw.z - last.z - (thickness[throw.link] + thickness[last.link]) / 2 if last else math.inf
        if last and between < most and math.hypot(last.x - throw.x, last.y - throw.y) < SAME:
            groups[-1].append(throw)
        else:
            groups.append([throw])
    found = []
    for group in groups:
        first, last = group[0], group[-1]
        x, y = first.x - shaft.axis[0], first.y - shaft.axis[1]
        low, high = first.z - thickness[first.link] / 2 - gap, last.z + thickness[last.link] / 2 + gap
        found.append(Pin(x, y, low, high, tuple(throw.link for throw in group)))
    return found


def _between(measures: Measures, shaft: Shaft, pins: list[Pin], unit: float) -> tuple[list[Web], list[Journal]]:
    """Webs and journals between the crank pins; the first and the last web stand for those at the ends."""
    spaces = [after.low - before.high for before, after in pairwise(pins)]
    thick = min([WEB * unit, *(SHARE * space for space in spaces if space >= _both(unit))])
    end = Web(0.0, thick, (), True)
    webs, journals = [end], []
    for (before, after), space in zip(pairwise(pins), spaces, strict=True):
        places = (before.x, before.y), (after.x, after.y)
        if space >= _both(unit):
            low, high = before.high + thick, after.low - thick
            webs += [Web(before.high, low, places[:1], True), Web(high, after.low, places[1:], True)]
            journals.append(Journal(low, high))
        elif space >= LEAST_WEB * unit:
            webs.append(Web(before.high, after.low, places, False))
        else:
            first, second = before.links[-1], after.links[0]
            z = [link.z for link in (measures.machine.links[first], measures.machine.links[second])]
            raise UserError(
                f"{measures.machine.m.name}: '{first}' and '{second}' are {z[1] - z[0]:.4g} mm apart along z on "
                f"'{shaft.body}', on crank pins at different places; the web between them needs "
                f"{z[1] - z[0] - space + LEAST_WEB * unit:.4g} mm: move them apart along z"
            )
    return [*webs, end], journals


def _both(unit: float) -> float:
    """The least space for two webs and a journal."""
    return (2 * LEAST_WEB + LEAST_BEARING) * unit / (1 - 0.2)
