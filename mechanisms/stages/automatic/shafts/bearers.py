"""What carries a shaft: pillars on the base plate, and bearings between them (mm)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.planar import Rounded, around, disc, least_gap
from mechanisms.stages.automatic.shafts.passing import Takes
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechanisms.stages.automatic.shafts.bodies.kinds import Machine
    from mechanisms.stages.automatic.shafts.shaft_plan import Journal, ShaftPlan

PILLAR = 0.085
"""Radius of a pillar, in bores."""
HUB, BOSS = 1.45, 1.9
"""Radii of a bearing in the journal's, and of its ends round the pillars in theirs."""
LONGEST = 1.3
"""Length of a bearing, in radii of its journal."""
MOST, APART = 4, math.radians(55)
"""Pillars of a shaft, and their least angle about it."""
WIDER = (1.0, 1.15, 1.35, 1.6, 2.0, 2.5)
"""Distances from the axis that are tried, in the nearest one."""
STEP = 5
EVERY = 4
"""Step between the poses at which places for pillars are looked at."""
ROOM = 0.5
"""Gap (mm) that is left there."""


@dataclass(frozen=True, eq=False)
class Bearers:
    """Where the pillars of a shaft stand on ground."""

    plan: ShaftPlan
    radius: float
    places: tuple[tuple[float, float], ...]
    running: float
    """Gap of a journal in its bearing."""
    journals: tuple[Journal, ...]
    """Those that have a bearing."""
    tapered: bool = False
    """Whether there is room for its arms only as they are, thinner towards the pillars."""

    @property
    def hub(self) -> float:
        """Outer radius of a bearing."""
        return HUB * self.plan.journal

    def takes(self, low: float) -> list[Takes]:
        """Pillars from ``low`` up, and bearings."""
        x, y = self.plan.shaft.at
        body, top = frozenset({self.plan.shaft.body}), self.top
        spaces = [Takes("a pillar", "ground", disc(*place, self.radius), low, top) for place in self.places]
        for journal in self.journals:
            a, b = heights_of(self.plan, journal)
            spaces.append(Takes("a bearing", "ground", disc(x, y, self.hub), a, b, body))
            for place in self.places:
                arm = _arm(self.plan, place, self.radius, self.tapered)
                spaces.append(Takes("the arm of a bearing", "ground", arm, a, b, body))
        return spaces

    @property
    def top(self) -> float:
        """Upper end of the pillars."""
        return heights_of(self.plan, self.plan.journals[-1])[1] + 0.05 * self.plan.unit


def bearers(
    machine: Machine, plan: ShaftPlan, taken: Sequence[Takes], running: float, flywheel: float = 0.0
) -> Bearers:
    """Find places for pillars that nothing comes near to, also not a flywheel of that radius. Raises UserError where
    there are not two.
    """
    radius = PILLAR * plan.unit
    room = 0.05 * plan.unit + (BOSS - 1) * radius
    nearest = max(plan.swept, _hubs_of_links(plan), flywheel) + BOSS * radius + 0.05 * plan.unit
    ends = plan.journals[0], plan.journals[-1]
    tries = [(tapered, journals) for tapered in (False, True) for journals in (plan.journals, ends)]
    for tapered, journals in tries:

        def holds(place: tuple[float, float], journal: Journal, tapered: bool = tapered) -> bool:
            return _is_free(machine, _arm(plan, place, radius, tapered), _beside(plan, journal, taken))

        for wider in WIDER:
            free = []
            for turn in np.radians(np.arange(0, 360, STEP)):
                place = _at(plan, wider * nearest, turn)
                if _is_free(machine, disc(*place, radius + room), taken) and all(
                    holds(place, journal) for journal in journals
                ):
                    free.append(turn)
            chosen = _spread(machine, plan, free)
            if len(chosen) >= 2:
                places = tuple(_at(plan, wider * nearest, turn) for turn in chosen)
                held = tuple(
                    journal
                    for journal in plan.journals
                    if journal in journals or all(holds(place, journal) for place in places)
                )
                return Bearers(plan, radius, places, running, held, tapered)
    raise UserError(
        f"{machine.m.name}: round the shaft '{plan.shaft.body}' there is no room for two pillars that carry its "
        f"bearings; bodies sweep all of it up to {WIDER[-1] * nearest:.4g} mm: leave one out "
        f"(automatic(m).leave_out), or write {shown_file(machine.m.name, 'parts')}"
    )


def _hubs_of_links(plan: ShaftPlan) -> float:
    return max((math.hypot(pin.x, pin.y) for pin in plan.pins), default=0.0) + 1.5 * plan.pin


def _at(plan: ShaftPlan, away: float, turn: float) -> tuple[float, float]:
    x, y = plan.shaft.at
    return float(x + away * math.cos(turn)), float(y + away * math.sin(turn))


def _arm(plan: ShaftPlan, place: tuple[float, float], radius: float, tapered: bool) -> Rounded:
    """Arm of a bearing, from the axis to a pillar."""
    wide, end = 0.8 * HUB * plan.journal, BOSS * radius
    if tapered and wide > end:
        (x, y), turns = plan.shaft.at, [k * math.pi / 8 for k in range(16)]
        return around([place, *((x + (wide - end) * math.cos(t), y + (wide - end) * math.sin(t)) for t in turns)], end)
    return around([plan.shaft.at, place], max(BOSS * radius, 0.8 * HUB * plan.journal))


def _beside(plan: ShaftPlan, journal: Journal, taken: Sequence[Takes]) -> list[Takes]:
    """What shares heights with a bearing."""
    low, high = heights_of(plan, journal)
    return [space for space in taken if space.low < high and space.high > low]


def heights_of(plan: ShaftPlan, journal: Journal) -> tuple[float, float]:
    """Lower and upper face of a bearing, in the middle of its journal."""
    half = min((journal.high - journal.low) / 2 - plan.gap, LONGEST * plan.journal / 2)
    middle = (journal.low + journal.high) / 2
    return middle - half, middle + half


def _is_free(machine: Machine, shape: Rounded, taken: Sequence[Takes]) -> bool:
    """Whether nothing comes near to a shape on ground."""
    still = machine.poses["ground"][::EVERY]
    return all(
        least_gap(space.shape, shape, (machine.poses[space.body][::EVERY], still), ROOM)[0] >= ROOM for space in taken
    )


def _spread(machine: Machine, plan: ShaftPlan, free: list[float]) -> list[float]:
    """First the direction that is farthest from all bores, then always the farthest from those chosen."""
    bores = [math.atan2(piston.along[1], piston.along[0]) for piston in machine.pistons.values()]
    chosen: list[float] = []
    while free and len(chosen) < MOST:
        beside = chosen or bores or [math.pi / 2]
        away = [min(abs(math.remainder(turn - other, math.tau)) for other in beside) for turn in free]
        best = int(np.argmax(np.round(away, 6)))
        if chosen and away[best] < APART:
            break
        chosen.append(float(free[best]))
    return chosen
