"""The times of an animation, and the solution at these times.

A motion that repeats is a round trip without a doubled frame; others are shown forwards once. A simulation integrates
to the times. A sweep is interpolated: poses follow the polynomial of degree 5 that has position, velocity and
acceleration of the outputs at both ends; loads are straight lines in time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.results.solution import Solution

SHORTEST, LONGEST = 1.0, 40.0
"""Seconds on the screen within which real time is kept."""
HOLD = 0.8
"""Seconds for which the last picture of a motion that does not repeat stands."""
MOST = 6000
"""Pictures of an animation."""


@dataclass(frozen=True)
class Clip:
    """When the pictures are."""

    times: np.ndarray
    """(N,) of the motion (s), rising; the end of a period is left out, because it is its start."""
    fps: float
    rate: float
    """Seconds of the motion in a second on the screen."""
    repeats: bool

    @property
    def seconds(self) -> float:
        """On the screen, once through."""
        return len(self.times) / self.fps + (0.0 if self.repeats else HOLD)

    @property
    def words(self) -> str:
        """Return the words about the playback rate; empty at real time."""
        if math.isclose(self.rate, 1.0, rel_tol=1e-9):
            return ""
        if self.rate < 1.0 and math.isclose(round(1 / self.rate), 1 / self.rate, rel_tol=1e-9):
            return f"{round(1 / self.rate)} times slower"
        return f"{self.rate:.3g} times real time" if self.rate < 1.0 else f"{self.rate:.3g} times faster"


def clip_of(sol: Solution, rate: float | None, fps: float) -> Clip:
    """Return the clip of a whole solution.

    ``rate`` None: real time, or a round part of it if too short or long.

    Raises ModelError for a solution at a single time, and for more pictures than an animation may have.
    """
    m, period = sol.mechanism, sol.period
    if len(sol.t) < 2:
        raise ModelError(f"{m.name}: the solution has one time; an animation needs a motion: sweep(steps=...)")
    start, span = float(sol.t[0]), float(sol.t[-1] - sol.t[0])
    repeats = period is not None and bool(np.abs(sol.v).max(initial=0.0) > 0)
    if rate is None:
        rate = _round_rate(span)
    wanted = span * fps / rate
    if wanted > MOST:
        raise ModelError(
            f"{m.name}: {span:.4g} s at a rate of {rate:g} and {fps:g} pictures a second are {wanted:.0f} pictures; "
            f"an animation has {MOST} at most. Give a higher rate=, a lower fps=, or a shorter solution"
        )
    if wanted < 1.0:
        raise ModelError(
            f"{m.name}: {span:.4g} s at a rate of {rate:g} and {fps:g} pictures a second are less than one picture; "
            f"give a rate= of {span * fps / 2:.2g} or less"
        )
    if repeats:
        count = max(2, round(wanted))
        return Clip(start + span * np.arange(count) / count, fps, rate, True)
    count = max(2, math.floor(wanted + 1e-9) + 1)
    times = start + rate / fps * np.arange(count)
    return Clip(np.minimum(times[times <= sol.t[-1] + 1e-9 * span], sol.t[-1]), fps, rate, False)


def _round_rate(span: float) -> float:
    """Return 1 if ``span`` (s) is watchable, else the nearest of ..., 1/5, 1/2, 2, 5, ..."""
    rate, steps = 1.0, (2.0, 2.5, 2.0)
    for k in range(60):
        if span / rate < SHORTEST:
            rate /= steps[k % 3]
        elif span / rate > LONGEST:
            rate *= steps[k % 3]
        else:
            break
    return 1.0 / round(1.0 / rate) if rate < 1.0 and 1.0 / rate < 1e6 else rate


def at_times(sol: Solution, times: np.ndarray) -> Solution:
    """Return ``sol`` at rising ``times`` (T,) within its own (s)."""
    if len(sol.t) == len(times) and np.array_equal(sol.t, times):
        return sol
    if sol.between is not None:
        return replace(sol.at(times), events=sol.events)
    place = np.clip(np.searchsorted(sol.t, times, side="right") - 1, 0, max(0, len(sol.t) - 2))
    after = np.minimum(place + 1, len(sol.t) - 1)
    step = sol.t[after] - sol.t[place]
    part = np.divide(times - sol.t[place], step, out=np.zeros(len(times)), where=step > 0)
    q, v, a = _quintic(sol, place, after, step[:, None, None], part[:, None, None])

    def mixed(values: np.ndarray) -> np.ndarray:
        share = part.reshape(-1, *(1,) * (values.ndim - 1))
        return (1 - share) * values[place] + share * values[after]

    return replace(
        sol,
        t=np.asarray(times, float),
        law_times=None,
        q=q,
        v=v,
        a=a,
        wrench=mixed(sol.wrench),
        lam=mixed(sol.lam),
        drives=mixed(sol.drives),
        margin=mixed(sol.singularity_margin),
        work=None if sol.work is None else mixed(sol.work),
        held=None if sol.held is None else sol.held[place],
        efforts={name: mixed(effort) for name, effort in sol.efforts.items()},
        span=sol.span or (float(sol.t[0]), float(sol.t[-1])),
    )


def _quintic(
    sol: Solution, place: np.ndarray, after: np.ndarray, h: np.ndarray, s: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return q, v, a (T, nb, 3) at the parts ``s`` of steps ``h`` (s)."""
    q0, v0, a0 = sol.q[place], h * sol.v[place], h * h * sol.a[place]
    gap = sol.q[after] - q0 - v0 - 0.5 * a0
    slope = h * sol.v[after] - v0 - a0
    bend = h * h * sol.a[after] - a0
    c3, c4, c5 = 10 * gap - 4 * slope + 0.5 * bend, -15 * gap + 7 * slope - bend, 6 * gap - 3 * slope + 0.5 * bend
    q = q0 + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))))
    v = v0 + s * (a0 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))
    a = a0 + s * (6 * c3 + s * (12 * c4 + s * 20 * c5))
    h = np.where(h > 0, h, 1.0)
    return q, v / h, a / h**2
