"""Events that last a moment: a tip that passes close by a point; found by simulations, and by a dense search."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import minimize_scalar

from mbsd import Mechanism, distance_reaches
from mbsd.results.solution import Solution
from tools.hunt.mechanisms.free import chain
from tools.hunt.subject import Subject, family

LOOKS = 4000
CLEAR = 2e-2
"""Part of a distance within which a passage counts as grazing, and is not judged."""


@family("events that last a moment")
def passing(rng: np.random.Generator) -> Subject:
    """One or two bars, and a point beside the path of their end."""
    m = Mechanism("passing")
    end = chain(m, rng, int(rng.integers(1, 3)), False)[-1].end
    duration = float(rng.uniform(0.3, 1.0))
    m.trace("tip", end)
    dense = m.simulate(duration, steps=LOOKS, tolerance=1e-11)
    at = int(rng.integers(LOOKS // 10, LOOKS))
    tip = dense.point("tip")
    place, speed = np.stack([tip.x, tip.y]), np.stack([tip.vx, tip.vy])
    near = float(10 ** rng.uniform(-5, -1))
    across = np.array([-speed[1, at], speed[0, at]]) / np.hypot(*speed[:, at])
    x, y = (place[:, at] + float(rng.uniform(-1.5, 1.5)) * near * across).tolist()
    m.event("near", distance_reaches(m.ground.at(x, y), end, near))
    away = CubicHermiteSpline(dense.t, place.T - [x, y], speed.T)
    passages = _passages(away, dense.t, near)
    return Subject(m, duration, False, truth=_meets(passages), traits=frozenset({"events"}))


def _passages(away: CubicHermiteSpline, t: np.ndarray, near: float) -> list[float] | None:
    """Times of the closest places that are nearer than ``near`` (m), None where one grazes or the ends are near."""

    def distance(time: float) -> float:
        return float(np.hypot(*away(time)))

    apart = np.hypot(*away(t).T)
    if min(apart[0], apart[-1]) < 3 * near:
        return None
    out = []
    for k in np.flatnonzero((apart[1:-1] <= apart[:-2]) & (apart[1:-1] <= apart[2:])) + 1:
        nearest: Any = minimize_scalar(
            distance, bounds=(t[k - 1], t[k + 1]), method="bounded", options={"xatol": 1e-13}
        )
        if abs(nearest.fun - near) < CLEAR * near + 1e-7:
            return None
        if nearest.fun < near:
            farthest = np.hypot(*away(np.linspace(out[-1], nearest.x, LOOKS)).T).max() if out else np.inf
            if abs(farthest - near) < CLEAR * near + 1e-7:
                return None
            if farthest > near:  # else it has not left since
                out.append(float(nearest.x))
    return out


def _meets(passages: list[float] | None) -> Callable[[Solution], list[str]]:
    def problems(sol: Solution) -> list[str]:
        if passages is None:
            return []
        times = [event.time for event in sol.events]
        between = [a < passed < b for a, passed, b in zip(times[::2], passages, times[1::2], strict=False)]
        if len(times) == 2 * len(passages) and all(between):
            return []
        return [f"events at {times} s, but the tip passes at {passages} s"]

    return problems
