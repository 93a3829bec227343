"""Trails of traced points, and rings where bodies hit each other.

A trail is smooth between the pictures, bright behind the point and faint farther back. A ring spreads from an impact,
larger for a larger impulse.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd.drawing.animation.brush import Brush, rgba
from mbsd.drawing.animation.clip import Clip, at_times
from mbsd.drawing.animation.scene import Scene
from mbsd.drawing.animation.words import TRAIL
from mbsd.drawing.look import MOVED
from mbsd.results.acting import acting
from mbsd.results.solution import Solution

PARTS = 4
"""Pieces between two known places."""
BRIGHT = 0.3
"""Fraction of the whole motion: how far back the trail is bright."""
SHADES = 10
FAINT, STRONG = 0.20, 0.9


@dataclass(frozen=True)
class Trail:
    """One point."""

    times: np.ndarray
    path: np.ndarray
    """(k, 2) m."""
    colour: str


def trails_of(whole: Solution, here: Solution) -> list[Trail]:
    """Return the trails of all traced points, from the outputs and the pictures together."""
    times, first = np.unique(np.concatenate([whole.t, here.t]), return_index=True)
    jumps = np.array([event.time for event in whole.events])
    out = []
    for name in whole.mechanism.traces:
        a, b = whole.point(name), here.point(name)
        place = np.concatenate([np.stack([a.x, a.y], axis=1), np.stack([b.x, b.y], axis=1)])[first]
        speed = np.concatenate([np.stack([a.vx, a.vy], axis=1), np.stack([b.vx, b.vy], axis=1)])[first]
        out.append(Trail(*_smooth(times, place, speed, jumps), TRAIL))
    return out


def draw_trails(brush: Brush, trails: list[Trail], clip: Clip, k: int) -> None:
    """Draw trails at picture ``k``: whole and faint if the motion repeats, else up to now.

    The last part is bright.
    """
    now, span = float(clip.times[k]), float(np.ptp(clip.times)) * len(clip.times) / max(1, len(clip.times) - 1)
    for trail in trails:
        times, path = trail.times, trail.path
        if clip.repeats:
            brush.stroke(brush.view.pixels(path), rgba(trail.colour, FAINT), 1.3, 1.0)
            times = np.concatenate([times - span, times])
            path = np.concatenate([path, path])
        else:
            passed = path[times <= now + 1e-12]
            if len(passed) > 1:
                brush.stroke(brush.view.pixels(passed), rgba(trail.colour, 1.6 * FAINT), 1.3, 1.0)
        edges = np.linspace(now - BRIGHT * span, now, SHADES + 1)
        ends = np.searchsorted(times, edges + 1e-12, side="right")
        for shade in range(SHADES):
            piece = path[max(ends[shade] - 1, 0) : ends[shade + 1]]
            if len(piece) > 1:
                strength = FAINT + (STRONG - FAINT) * ((shade + 1) / SHADES) ** 1.5
                brush.stroke(brush.view.pixels(piece), rgba(trail.colour, strength), 1.2 + 1.0 * shade / SHADES, 1.1)


def _smooth(t: np.ndarray, x: np.ndarray, v: np.ndarray, jumps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return cubic pieces with the known velocities; straight ones where the velocity jumps."""
    h = np.diff(t)[:, None, None]
    s = (np.arange(PARTS) / PARTS)[None, :, None]
    a, b, va, vb = x[:-1, None], x[1:, None], h * v[:-1, None], h * v[1:, None]
    bent = a + s * (va + s * (3 * (b - a) - 2 * va - vb + s * (2 * (a - b) + va + vb)))
    broken = np.zeros(len(h), bool)
    if len(jumps):
        broken[np.clip(np.searchsorted(t, jumps, side="right") - 1, 0, len(h) - 1)] = True
        broken[np.clip(np.searchsorted(t, jumps, side="left") - 1, 0, len(h) - 1)] = True
    path = np.where(broken[:, None, None], a + s * (b - a), bent)
    times = t[:-1, None] + np.diff(t)[:, None] * s[0, :, 0]
    return np.append(times.ravel(), t[-1]), np.vstack([path.reshape(-1, 2), x[-1:]])


SECONDS = 0.35
"""Time for which the ring is seen."""
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
    """Return the hardest ones, that are worth a ring."""
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
