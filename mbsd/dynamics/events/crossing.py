"""Where in a step a monitored scalar first falls through zero.

Interior samples of the step's quintic also find scalars that dip below zero and come back, and those that leave zero
at the start of the step (a bounce) and return within it. What dips between two samples is found by its minimum
(dips.py). A gap that begins within rounding of zero, or an error of the
integrator below, and opens by its rate and its acceleration, does not close there: a multistep method begins anew with
steps of order one, whose errors in places are above the gap while it is so young.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from mbsd.dynamics.events.bounds import HALVINGS
from mbsd.dynamics.events.dips import first_dip
from mbsd.dynamics.events.monitors import Monitor, Samples
from mbsd.model.event import Event

PARTS = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])


def first_crossing(
    monitors: Sequence[Monitor],
    samples: Callable[[np.ndarray], Samples],
    true: Callable[[Monitor, float], float],
    looked: Callable[[Monitor, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]],
    rounding: Callable[[Event], float],
) -> tuple[Monitor, float, float] | None:
    """The monitor that falls through zero first, the part of the step where, and a part where it is negative.

    ``samples(x)`` gives what monitors read at parts x (S,) of the step, ``true`` the scalar of the motion itself at
    one; ``looked`` adds parts and values where those of an event of the user do not tell how it goes, and ``rounding``
    says by how much its value at the start of the step may be off.
    """
    at_parts, earliest = samples(PARTS), None
    for monitor in monitors:
        parts, values = PARTS, monitor.value(at_parts)
        if monitor.event is not None:
            parts, values = looked(monitor, parts, values)
        met = _falls(monitor, samples, parts, values, None if earliest is None else earliest[2], rounding)
        before = len(parts) if met is None else int(np.searchsorted(parts, met[0], side="right"))

        def quintic(x: float, monitor: Monitor = monitor) -> float:
            return float(monitor.value(samples(np.array([x])))[0])

        def truth(x: float, monitor: Monitor = monitor) -> float:
            return true(monitor, x)

        dip = first_dip(parts[:before], values[:before], monitor.still, quintic, truth)
        if dip is not None:
            above, below = quintic(dip.above), quintic(dip.below)
            crosses = above > 0.0 > below
            where = _root_between(quintic, *dip, above, below) if crosses else 0.5 * sum(dip)
            met = where, dip.below
        if met is not None and (earliest is None or met[0] < earliest[1]):
            earliest = monitor, *met
    return earliest


def _falls(
    monitor: Monitor,
    samples: Callable[[np.ndarray], Samples],
    parts: np.ndarray,
    values: np.ndarray,
    until: float | None,
    rounding: Callable[[Event], float],
) -> tuple[float, float] | None:
    """Where samples ``values`` at ``parts`` (n,) show a fall through zero, and a part where the scalar is negative."""
    below = np.flatnonzero(values[1:] < -monitor.still)
    if not len(below):
        return None
    k = int(below[0])
    if until is not None and parts[k] >= until:
        return None
    zero = monitor.still
    if k == 0 and monitor.event is not None and values[0] > zero:
        zero = rounding(monitor.event)  # it may have begun here: a root beside it is none
    where, negative = _root(monitor, samples, parts, values, k, zero)
    if where == 0.0 and monitor.leaves is not None and monitor.leaves(samples(PARTS[[0, -1]])):
        opened = np.flatnonzero(values > monitor.still)
        below = below[below >= opened[0]] if len(opened) else below[:0]
        if not len(below):
            return None
        where, negative = _root(monitor, samples, parts, values, int(below[0]), monitor.still)
    return where, negative


def _root(
    monitor: Monitor,
    samples: Callable[[np.ndarray], Samples],
    parts: np.ndarray,
    values: np.ndarray,
    k: int,
    zero: float,
) -> tuple[float, float]:
    """Between parts k and k + 1 of the step; a value up to ``zero`` at the first of them is taken to begin there."""
    left, right = float(parts[k]), float(parts[k + 1])
    at_left, at_right = float(values[k]), float(values[k + 1])
    level = min(0.0, max(at_left, -monitor.still))  # within rounding it counts as zero

    def value(x: float) -> float:
        return float(monitor.value(samples(np.array([x])))[0]) - level

    negative, above, below = right, at_left - level, at_right - level
    if at_left <= zero:
        start, positive = left, None
        for _ in range(HALVINGS):
            middle = 0.5 * (start + right)
            there = value(middle)
            if there > 0.0:
                positive, above = middle, there
                break
            right, below = middle, there
        if positive is None:
            return start, negative
        left = positive
    return _root_between(value, left, right, above, below), negative


def _root_between(value: Callable[[float], float], left: float, right: float, at_left: float, at_right: float) -> float:
    """A root between two parts where the value is known; to look again may give another sign of what is rounding."""
    from scipy.optimize import brentq

    known = {left: at_left, right: at_right}
    return float(brentq(lambda x: known[x] if x in known else value(x), left, right, xtol=1e-14))  # pyright: ignore[reportArgumentType]
