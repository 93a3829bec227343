"""Differences of two outcomes of a run, in parts of its sizes, and what small changes of numbers move."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from mbsd import Mechanism
from mbsd.dynamics.simulate import integrator_named
from tools.numbers.events.record import TOLERANCE, Case, Moment, Outcome, Sizes, run

# How far two outcomes of a run are from each other, in parts of its sizes.


class Difference(NamedTuple):
    """The largest differences; infinite where something else happened."""

    motion: float
    forces: float
    where: str
    """The farthest value, or the one that is not the same."""


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


# How far a run moves when its numbers move a little, which says how near another solver can come to it.
#
# Gravity, masses, velocities at the start, restitution and friction are moved by parts of 1e-13, some five hundred
# roundings, and the tolerance by a tenth, which ends steps elsewhere. A run moves by its own condition: each bounce
# divides a speed and multiplies the error of its time, friction has kinks where something begins to stick. Its bound is
#
#     within = max(1e-9, 10 moved), in powers of ten;   a run that moved by more than 1e-6 is too long to be recorded.


PART = 1e-13
LEAST, MOST = 1e-9, 1e-6
MARGIN = 10.0
TOLERANCES = (0.9, 1.1)
"""Factors of the tolerance."""


def moved(case: Case, outcome: Outcome) -> list[tuple[str, Difference]]:
    """Return what each small change does to a run."""
    times = [moment.t for moment in outcome.between]
    out = [
        (name, difference(outcome, run(case, times, change(case.build())))) for name, change in _changes(case).items()
    ]
    tolerance = float(case.options.get("tolerance", TOLERANCE))
    fixed = integrator_named(case.name, case.options.get("method", "dop853")).fixed_step
    for factor in () if fixed else TOLERANCES:
        out.append((f"tolerance {factor:g}", difference(outcome, run(case, times, tolerance=factor * tolerance))))
    return out


def bound(moved: float) -> float:
    """Return the bound for a run that moved so far."""
    return max(LEAST, 10.0 ** math.ceil(math.log10(max(MARGIN * moved, 1e-300)) - 1e-9))


def _changes(case: Case) -> dict[str, Callable[[Mechanism], Mechanism]]:
    return {
        "gravity and speeds": lambda m: _speeds(m, 1.0 + PART),
        "masses": lambda m: _masses(m, even=case.even),
        "contacts": lambda m: _contacts(m, 1.0 - PART),
    }


def _speeds(m: Mechanism, factor: float) -> Mechanism:
    if m.gravity is not None:
        m.gravity = (m.gravity[0] * factor, m.gravity[1] * factor)
    for name, given in m.velocities.items():
        place = None if given.place is None else (factor * given.place[0], factor * given.place[1])
        m.velocities[name] = replace(given, omega=factor * given.omega, place=place)
    return m


def _masses(m: Mechanism, even: bool) -> Mechanism:
    for k, (name, body) in enumerate(m.bodies.items()):
        if body.mass:
            m.change(name, mass=body.mass * (1.0 + PART * (1 if even else 1 + k % 3)))
    return m


def _contacts(m: Mechanism, factor: float) -> Mechanism:
    for name, contact in m.contacts.items():
        new = dict(_numbers(contact.params, factor))
        if new:
            m.change(name, **new)
    return m


def _numbers(params: Mapping[str, Any], factor: float) -> Iterator[tuple[str, float]]:
    for key in ("restitution", "friction", "static_friction"):
        if params.get(key):
            yield key, params[key] * factor
