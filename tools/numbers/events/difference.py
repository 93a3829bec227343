"""How far two outcomes of a run are from each other, in parts of its sizes."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tools.numbers.events.record import Moment, Outcome, Sizes


class Difference(NamedTuple):
    """The largest differences; infinite where something else happened."""

    motion: float
    forces: float
    where: str
    """What is farthest, or what is not the same."""


def difference(before: Outcome, now: Outcome) -> Difference:
    """Compare two outcomes; sizes are those of the first.

    Names, what happened, its order, the number of outputs and the rows that hold at each must be the same.
    """
    other = _other(before, now)
    if other:
        return Difference(math.inf, math.inf, other)
    if before.error:
        return Difference(0.0, 0.0, "")
    sizes = before.sizes
    assert sizes is not None
    parts: list[tuple[float, str]] = [(abs(before.work - now.work) / sizes.energy, "work")]
    for a, b in zip(before.happened, now.happened, strict=True):
        what = f"of '{a[1]}' that {a[2]} at {a[0]:.6g} s"
        parts += [
            (abs(a[0] - b[0]) / sizes.time, f"time {what}"),
            (abs(a[3] - b[3]) / sizes.impulse, f"impulse {what}"),
            (abs(a[4] - b[4]) / sizes.energy, f"energy {what}"),
        ]
    forces: list[tuple[float, str]] = [(0.0, "")]
    for a, b in zip(_moments(before), _moments(now), strict=True):
        q, v = _scales(sizes, len(a.q))
        parts += [
            (abs(a.t - b.t) / sizes.time, "time of the end"),
            (_farthest(a.q, b.q, q), f"places at {a.t:.6g} s"),
            (_farthest(a.v, b.v, v), f"velocities at {a.t:.6g} s"),
        ]
        forces.append((_farthest(a.forces, b.forces, sizes.force), f"forces at {a.t:.6g} s"))
    for a, b in zip(before.rows, now.rows, strict=True):
        parts.append((_farthest(a, b, np.tile(_scales(sizes, len(a) // 2)[1], 2)), "velocities beside events"))
    motion, force = max(parts), max(forces)
    return Difference(motion[0], force[0], motion[1] if motion[0] >= force[0] else force[1])


def _other(before: Outcome, now: Outcome) -> str:
    """Return what makes them outcomes of another kind, or nothing."""
    if before.error != now.error:
        return f"{before.error or 'no error'} before, {now.error or 'no error'} now {now.text}"
    before_words, now_words = ([(e[1], e[2]) for e in each.happened] for each in (before, now))
    if before_words != now_words:
        pairs = enumerate(zip(before_words, now_words, strict=False))
        first = next((k for k, (a, b) in pairs if a != b), min(len(before_words), len(now_words)))
        other = now_words[first] if first < len(now_words) else "nothing"
        return f"{len(before_words)} events before, {len(now_words)} now; number {first} is {other} now"
    if before.outputs != now.outputs:
        return f"{before.outputs} outputs before, {now.outputs} now"
    if before.held != now.held:
        return f"other rows hold at outputs: {before.held} before, {now.held} now"
    same = [len(_moments(each)) for each in (before, now)], [len(each.rows) for each in (before, now)]
    if any(a != b for a, b in same):
        return "other rows beside events"
    return ""


def _moments(outcome: Outcome) -> list[Moment]:
    return [*outcome.between, *([] if outcome.end is None else [outcome.end])]


def _scales(sizes: Sizes, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Differences of places and velocities (count,)."""
    places, rates = sizes.of_bodies()
    return np.tile(places, count // 3), np.tile(rates, count // 3)


def _farthest(a: list[float], b: list[float], scale: np.ndarray | float) -> float:
    """The largest difference in parts of the scale; infinite where one is not a number."""
    apart = np.abs(np.array(a) - np.array(b)) / scale
    return float(apart.max(initial=0.0)) if np.isfinite(apart).all() else math.inf
