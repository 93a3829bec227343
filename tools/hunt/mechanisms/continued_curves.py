"""Points and discs on open curves that cross their straight continuations, or pass close by themselves."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Mechanism
from mbsd.results.solution import Solution
from tools.hunt.subject import Subject, family

KEPT = 1e-6
"""Part of the largest kinetic energy by which the energy may change."""


@family("points on open curves that go on through themselves")
def continued(rng: np.random.Generator) -> Subject:
    """An arc beyond half a circle, a spiral, a loop that crosses itself, a hook; a bead or a rolling disc."""
    kind, count = int(rng.integers(4)), int(rng.integers(25, 60))
    if kind == 0:
        a = np.linspace(-1.0, 1.0, count) * float(rng.uniform(1.6, 3.0))
        points = np.stack([np.sin(a), -np.cos(a)], axis=1)
    elif kind == 1:
        a = np.linspace(0.0, float(rng.uniform(7.0, 12.0)), count)
        points = (1 - float(rng.uniform(0.03, 0.06)) * a)[:, None] * np.stack([np.sin(a), -np.cos(a)], axis=1)
    elif kind == 2:
        a = np.linspace(-1.0, 1.0, count) * float(rng.uniform(1.7, 2.8))
        points = np.stack([0.5 * np.sin(2 * a), np.cos(a)], axis=1)
    else:
        a = np.linspace(0.0, math.pi, count // 2)
        leg = np.stack([np.ones(8), np.linspace(3.0, 0.2, 8)], axis=1)
        points = np.concatenate([leg, np.stack([0.5 + 0.5 * np.cos(a), -0.5 * np.sin(a)], axis=1)])
    points = points[:: int(rng.choice([-1, 1]))]
    return _running(rng, points, (0.0, 0.02, 0.04))


@family("points on curves beside themselves", weight=0.5)
def beside(rng: np.random.Generator) -> Subject:
    """A hairpin, a way to and fro, the same with crooked legs; a bead or a small rolling disc."""
    kind, gap = int(rng.integers(3)), float(10 ** rng.uniform(-1.5, -0.5))
    turn, up = np.linspace(0.0, math.pi, 9)[1:-1], np.linspace(0.0, 1.0, int(rng.integers(5, 15)))
    legs, parts = 2 if kind == 0 else int(rng.integers(3, 7)), []
    for leg in range(legs):
        x, down = 2.0 * gap * leg, leg % 2 == 1
        parts.append(np.stack([np.full(len(up), x), up[::-1] if down else up], axis=1))
        if leg < legs - 1:
            over = -gap * np.sin(turn) if down else 1.0 + gap * np.sin(turn)
            parts.append(np.stack([x + gap * (1.0 - np.cos(turn)), over], axis=1))
    points = np.concatenate(parts)
    if kind == 2:
        points += 0.05 * gap * rng.normal(size=points.shape)
    return _running(rng, points, (0.0, 0.05 * gap))


def _running(rng: np.random.Generator, points: np.ndarray, radii: tuple[float, ...]) -> Subject:
    """A bead, or a disc of one of the radii, that begins somewhere on a curve and runs along it."""
    m = Mechanism("continued", gravity=(0.0, float(rng.choice([0.0, -9.81]))))
    at = int(rng.integers(2, len(points) - 2))
    way = points[at + 1] - points[at - 1]
    way /= np.hypot(*way)
    speed = float(rng.uniform(2.0, 8.0) * rng.choice([-1, 1]))
    radius = float(rng.choice(radii))
    x, y = (points[at] + radius * np.array([-way[1], way[0]])).tolist()
    body = m.body("bead", 1.0, inertia=0.01)
    if radius:
        m.rolling_on_curve("track", m.ground.origin, body.origin, points.tolist(), radius)
    else:
        m.point_on_curve("track", m.ground.origin, body.origin, points.tolist())
    m.start_near(bead=(x, y, 0.0))
    m.start_moving(bead=(speed * float(way[0]), speed * float(way[1]), -speed / radius if radius else 0.0))
    return Subject(m, float(rng.uniform(0.5, 2.0)), False, truth=_keeps_energy, traits=frozenset({"jumps"}))


def _keeps_energy(sol: Solution) -> list[str]:
    assert sol.audit is not None
    lost, most = float(np.ptp(sol.audit)), float(sol.energy.kinetic.max())
    return [f"energy changes by {lost:.3g} of {most:.3g} J"] if lost > KEPT * most else []
