"""Pillars and bearings of a shaft (mm)."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.shafts.bearers import BOSS, heights_of
from mechanisms.stages.automatic.shafts.solids.link_solids import split
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.genus import through_holes
from shared.shapes.kernel import first_sound
from shared.shapes.solid import Solid

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.shafts.bearers import Bearers
    from mechanisms.stages.automatic.shafts.shaft_plan import Journal

ARM = 0.62
"""Thickness of the arms in the length of a bearing."""
SEAT = 0.02


def bearer_solids(own: Bearers, low: float, number: str) -> list[Solid]:
    """Pillars from ``low`` up, and bearings, those between throws of two halves."""
    solids = []
    for k, place in enumerate(own.places, start=1):
        shape = extruded(outline.circle(*place, own.radius), own.top - low, low)
        solids.append(Solid(f"pillar{number}_{k}", eased(shape, 0.15 * own.radius, "|Z", True), "steel", 0))
    last = len(own.journals)
    for k, journal in enumerate(own.journals, start=1):
        shape = _bearing(own, journal)
        if k in (1, last):
            solids.append(Solid(f"bearing{number}_{k}", shape, "aluminium", through_holes(shape)))
            continue
        x, y = own.plan.shaft.at
        upper, lower = split(shape, (x, y), _across(own), 20 * own.plan.journal + 4 * own.plan.swept)
        for name, half in (("bearing", lower), ("cap", upper)):
            solids.append(Solid(f"{name}{number}_{k}", half, "aluminium", through_holes(half)))
    return solids


def _across(own: Bearers) -> float:
    """Direction (rad) square to a line through the axis that stays clear of the arms, with some on either side."""
    x, y = own.plan.shaft.at
    arms = [math.atan2(v - y, u - x) for u, v in own.places]
    best, clear = 0.0, -1.0
    for turn in np.radians(np.arange(0, 180, 3)):
        sides = [math.sin(arm - turn) for arm in arms]
        if min(sides) < 0 < max(sides) and min(map(abs, sides)) > clear:
            best, clear = float(turn) + math.pi / 2, min(map(abs, sides))
    return best


def _bearing(own: Bearers, journal: Journal) -> cq.Workplane:
    plan = own.plan
    low, high = heights_of(plan, journal)
    x, y = plan.shaft.at
    thick = ARM * (high - low)
    middle = (low + high) / 2
    ring = extruded(outline.circle(x, y, own.hub), high - low, low)
    made = first_sound([partial(eased, ring, 0.03 * plan.unit, "|Z", True)])
    shape = ring if made is None else made
    for u, v in own.places:
        arm = outline.hull([(x, y, 0.8 * own.hub), (u, v, BOSS * own.radius)])
        shape = shape.union(extruded(arm, thick, middle - thick / 2))
    tools = [(x, y, plan.journal + own.running), *((u, v, own.radius + SEAT) for u, v in own.places)]
    for u, v, radius in tools:
        shape = shape.cut(extruded(outline.circle(u, v, radius), high - low + 2, low - 1))
    return shape
