"""A solution at other times: a simulation integrates to them, a sweep is the polynomials between its outputs.

Poses follow the polynomial of degree 5 that has position, velocity and acceleration of the outputs at both ends;
loads are straight lines in time.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mbsd.results.solution import Solution


def at_times(sol: Solution, times: np.ndarray) -> Solution:
    """``sol`` at rising ``times`` (T,) within its own (s)."""
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
    """q, v, a (T, nb, 3) at the parts ``s`` of steps ``h`` (s)."""
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
