"""Where in a step a monitored scalar first falls through zero.

Interior samples of the step's quintic also find scalars that dip below zero and come back, and those that leave zero
at the start of the step (a bounce) and return within it. A gap that begins within rounding of zero, or an error of the
integrator below, and opens by its rate and its acceleration, does not close there: a multistep method begins anew with
steps of order one, whose errors in places are above the gap while it is so young.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from mbsd.dynamics.events.monitors import Monitor, Samples

PARTS = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
HALVINGS = 40
"""How close to a bounce its return is looked for: this many halvings of a part of a step."""


def first_crossing(
    monitors: Sequence[Monitor], samples: Callable[[np.ndarray], Samples]
) -> tuple[Monitor, float, float] | None:
    """The monitor that falls through zero first, the part of the step where, and a part where it is negative.

    ``samples(x)`` gives what monitors read at parts x (S,) of the step.
    """
    at_parts, found = samples(PARTS), None
    for monitor in monitors:
        values = monitor.value(at_parts)
        below = np.flatnonzero(values[1:] < -monitor.still)
        if not len(below):
            continue
        k = int(below[0])
        if found is not None and PARTS[k] >= found[2]:
            continue
        where, negative = _root(monitor, samples, k, float(values[k]))
        if where == 0.0 and monitor.leaves is not None and monitor.leaves(samples(PARTS[[0, -1]])):
            opened = np.flatnonzero(values > monitor.still)
            below = below[below >= opened[0]] if len(opened) else below[:0]
            if not len(below):
                continue
            where, negative = _root(monitor, samples, int(below[0]), float(values[below[0]]))
        if found is None or where < found[1]:
            found = monitor, where, negative
    return found


def _root(monitor: Monitor, samples: Callable[[np.ndarray], Samples], k: int, at_left: float) -> tuple[float, float]:
    """Within part k of the step."""
    from scipy.optimize import brentq

    left, right = float(PARTS[k]), float(PARTS[k + 1])
    level = min(0.0, max(at_left, -monitor.still))  # within rounding it counts as zero

    def value(x: float) -> float:
        return float(monitor.value(samples(np.array([x])))[0]) - level

    negative = right
    if at_left <= monitor.still:
        start, positive = left, None
        for _ in range(HALVINGS):
            middle = 0.5 * (start + right)
            if value(middle) > 0.0:
                positive = middle
                break
            right = middle
        if positive is None:
            return start, negative
        left = positive
    return float(brentq(value, left, right, xtol=1e-14)), negative  # pyright: ignore[reportArgumentType]
