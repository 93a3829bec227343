"""A driven motion from start to end, as a Solution."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.closed_contacts import refuse_passed_contacts
from mbsd.curve_following import CurveFollowing, refuse_jumps
from mbsd.errors import ModelError
from mbsd.inverse_dynamics import inverse_dynamics
from mbsd.limits import limits_of, refuse_passed
from mbsd.model import Mechanism
from mbsd.output_times import equal_times, rising_times
from mbsd.prepared import prepare
from mbsd.solution import Solution, Stats


def sweep(m: Mechanism, duration: float | None, steps: int, times: Sequence[float] | np.ndarray | None) -> Solution:
    """See :meth:`mbsd.model.Mechanism.sweep`."""
    grid = sweep_times(m, duration, steps, times)
    ready = prepare(m, float(grid[0]), float(grid[-1]))
    march = ready.march(grid)
    q, v, a, packed = march.q, march.v, march.a, ready.packed
    drives = packed.drives(grid)
    if m.contacts or limits_of(packed):
        inner, poses = march.closely()
        refuse_passed(packed, inner, poses, smooth=True)
        refuse_passed_contacts(m, packed, inner, poses)
    if CurveFollowing(packed):
        refuse_jumps(packed, *march.closely())
    loads = inverse_dynamics(ready, grid, drives, q, v, a)
    shape = (len(grid), -1, 3)
    return Solution(
        mechanism=m,
        packed=packed,
        t=grid,
        q=q.reshape(shape),
        v=v.reshape(shape),
        a=a.reshape(shape),
        wrench=loads.wrench,
        lam=loads.lam,
        drives=drives,
        singularity_margin=loads.margin,
        stats=Stats(*(float(r) for r in loads.residuals), steps=len(grid), inserted_steps=march.steps.inserted),
        mobility=ready.mobility,
        route=ready.route if march.closed else "Newton-Raphson",
    )


def sweep_times(
    m: Mechanism, duration: float | None, steps: int, times: Sequence[float] | np.ndarray | None
) -> np.ndarray:
    """(T,) rising times (s) of a sweep. Raises ModelError."""
    if times is not None:
        return rising_times(m, times, 1)
    if duration is None:
        periods = [law.period for law in (d.motion for d in m.drivers.values()) if law is not None and law.period]
        if not periods and not m.drivers:
            duration = 1.0  # mobility will name the missing driver
        elif not periods:
            raise ModelError(f"{m.name}: no driver repeats, so there is no natural duration; say sweep(duration=...)")
        else:
            duration = float(periods[0])
    return equal_times(m, duration, steps)
