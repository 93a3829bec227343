"""Impacts: a ring that spreads where bodies hit each other, larger for a larger impulse."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd.drawing.animation.between import at_times
from mbsd.drawing.animation.brush import Brush, rgba
from mbsd.drawing.animation.clip import Clip
from mbsd.drawing.animation.scene import Scene
from mbsd.drawing.look import MOVED
from mbsd.results.acting import acting

SECONDS = 0.35
"""For which the ring is seen."""
SMALLEST = 0.02
"""Fraction of the largest impulse: smaller ones are not shown."""
MOST = 60


@dataclass(frozen=True)
class Impact:
    """One hit."""

    time: float
    place: np.ndarray
    """(2,) m."""
    part: float
    """Fraction of the largest impulse."""


def impacts_of(scene: Scene) -> list[Impact]:
    """The hardest ones, that are worth a ring."""
    sol, m = scene.whole, scene.whole.mechanism
    hits = [event for event in sol.events if event.what == "impact" and event.name in m.contacts]
    most = max((abs(event.impulse) for event in hits), default=0.0)
    hits = sorted(hits, key=lambda event: -abs(event.impulse))[:MOST]
    hits = [event for event in hits if abs(event.impulse) >= SMALLEST * most]
    if not hits or most <= 0.0:
        return []
    times = np.unique([min(event.time, float(sol.t[-1])) for event in hits])
    here = at_times(sol, times)
    out = []
    for event in hits:
        number = here.packed.joints.index(m.contacts[event.name])
        where = acting(here.packed, here.q, np.zeros_like(here.wrench), number)  # by the geometry alone
        k = int(np.argmin(np.abs(times - event.time)))
        out.append(Impact(event.time, np.array([where.x[k], where.y[k]]), abs(event.impulse) / most))
    return sorted(out, key=lambda impact: impact.time)


def draw_impacts(brush: Brush, impacts: list[Impact], clip: Clip, k: int) -> None:
    """Draw the impacts that were just before picture ``k``."""
    for impact in impacts:
        age = (float(clip.times[k]) - impact.time) / clip.rate / SECONDS
        if 0.0 <= age < 1.0:
            radius = (0.8 + 3.6 * math.sqrt(impact.part) * math.sqrt(age)) * brush.unit
            turn = np.linspace(0.0, 2 * math.pi, 49)
            ring = impact.place + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
            brush.stroke(brush.view.pixels(ring), rgba(MOVED, 0.85 * (1 - age)), 1.0 + 2.2 * (1 - age), 9.0)
