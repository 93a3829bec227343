"""A motion that grows without bound in finite time, as under a force that grows with the cube of an angle.

With V the size of all velocities, T = V / (dV/dt) is the time in which they double or so. Growth that ends at a time
t_e, V ~ (t_e - t)^-p, has T = (t_e - t) / p: it falls along a straight line that tells t_e, while T of exponential
growth stays and that of usual motions is of the size of what is left. Steps follow it for ever, each a part of T.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mbsd.dynamics.runs.diagnosis import loads_by_force, slope_at
from mbsd.dynamics.state import TIME, State

if TYPE_CHECKING:
    from mbsd.dynamics.runs.run import Run

BEYOND = 1e6
"""Velocities so many times those of the start, of a fall by the size, and of going by the size in the whole run."""
STRAIGHT = 0.05
"""How fast T falls at least: p of 20."""
SOON = 1e-3
"""Part of the time left within which growth ends."""
SHARE = 0.5
"""Part of the power of all inertia that the force which is named has at least."""


class Growth(NamedTuple):
    """Velocities at a time (s), in sizes/s and rad/s."""

    time: float
    size: float
    within: float
    """T (s)"""


def growth_of(run: Run, state: State) -> Growth | None:
    """How velocities grow where they are far beyond usual ones, else None."""
    dynamics, packed, ready = run.ready.dynamics, run.ready.packed, run.ready
    size = float(np.linalg.norm(state.y[1] * dynamics.per_size))
    fall = float(np.hypot(*packed.system.gravity)) / packed.size
    usual = max(float(np.linalg.norm(ready.initial.v * dynamics.per_size)), fall**0.5, 1.0 / (ready.end - ready.start))
    if not BEYOND * usual < size < np.inf:
        return None
    report = run.scratch.report.copy()
    slope = slope_at(run, state)
    run.scratch.report[...] = report
    if slope is None:
        return None
    rise = float(state.y[1] * dynamics.per_size @ (slope[1] * dynamics.per_size)) / size
    return Growth(float(state.clock[TIME]), size, size / rise) if rise > 0.0 else None


def runaway(run: Run, state: State, before: Growth | None, now: Growth | None) -> str | None:
    """What grows without bound, when and under which force, with the remedy; None where nothing does."""
    if before is None or now is None or not (now.time > before.time and now.size > 2.0 * before.size):
        return None
    falling = (before.within - now.within) / (now.time - before.time)
    if not falling > STRAIGHT or now.within / falling > SOON * (run.ready.end - now.time):
        return None
    return _words(run, state, now, now.time + now.within / falling, _driving(run, state))


def runaway_at(run: Run, state: State) -> str | None:
    """The same of one state: what a force drives so fast that it would be beyond all bounds within no time."""
    now = growth_of(run, state)
    if now is None or now.within > SOON * (run.ready.end - now.time):
        return None
    driving = _driving(run, state)
    return None if driving is None else _words(run, state, now, now.time + now.within, driving)


def _words(run: Run, state: State, now: Growth, ends: float, driving: tuple[str, float] | None) -> str:
    packed = run.ready.packed
    speeds = np.abs(state.y[1] * run.ready.dynamics.per_size).reshape(-1, 3)[1 : len(packed.body_names) - packed.states]
    fastest = packed.body_names[1 + int(np.argmax(speeds.max(axis=1)))]
    what = f"force '{driving[0]}'" if driving is not None else "what drives it"
    under = f"under force '{driving[0]}', which gives {driving[1]:.2g} W, " if driving is not None else ""
    return (
        f"'{fastest}' moves without bound: {under}its speed doubles within some {now.within:.1e} s, in ever shorter "
        f"times, which ends at t = {ends:.6g} s. Limit {what}, add "
        "damping that grows as well, or end the simulation before."
    )


def _driving(run: Run, state: State) -> tuple[str, float] | None:
    """The force that gives most of the power (W) of all inertia, and its power."""
    slope = slope_at(run, state)
    if slope is None:
        return None
    whole = float(run.ready.dynamics.inertia * slope[1] @ state.y[1])
    times = np.array([state.clock[TIME]])
    powers = [(float(loads[0] @ state.y[1]), force.name) for force, loads in loads_by_force(run, times, state.y[None])]
    power, name = max(powers, default=(0.0, ""))
    return (name, power) if power > SHARE * whole > 0.0 else None
