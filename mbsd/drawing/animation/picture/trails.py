"""Paths of traced points: smooth between the pictures, bright behind the point and faint farther back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.drawing.animation.brush import Brush, rgba
from mbsd.drawing.animation.clip import Clip
from mbsd.drawing.animation.words import TRAIL
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
    """Trails of all traced points, from the outputs and the pictures together."""
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
    """At picture ``k``: all of it, faint, if it repeats, else what was passed; the last part bright."""
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
    """Cubic pieces with the known velocities; straight ones where the velocity jumps."""
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
