"""A driven motion from start to end, as a Solution."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from mbsd.arrays.chambers import check_pistons, phase_changes, whole_cycles
from mbsd.arrays.curve_branches import CurveBranches
from mbsd.arrays.efforts_beside import efforts_beside
from mbsd.arrays.laws import compiled_laws, jump_times, reach_beside
from mbsd.arrays.states import with_states
from mbsd.base.arguments import number_array
from mbsd.base.errors import ModelError, ModelWarning
from mbsd.base.names import shown
from mbsd.base.warning import warn
from mbsd.kinematics.change_points.passages import determinant_of, sides_of
from mbsd.kinematics.limits.cables import refuse_left_wheels
from mbsd.kinematics.limits.contacts import refuse_passed_contacts
from mbsd.kinematics.limits.joints import limits_of, refuse_jumps, refuse_passed
from mbsd.kinematics.march import March, march_along
from mbsd.kinematics.multipliers import Efforts, inverse_dynamics, singularity_margin
from mbsd.kinematics.period import MOST_TURNS, common_period, repetition
from mbsd.kinematics.prepared import Prepared, prepare, prepare_beside
from mbsd.kinematics.states_along import Motion, refine_times, states_along
from mbsd.model.mechanism import Model
from mbsd.model.output_times import equal_times, rising_times
from mbsd.results.measured import check_states
from mbsd.results.rows import Asked, jumps_of
from mbsd.results.solution import Beside, Solution, returned
from mbsd.results.views import Stats


def sweep(
    m: Model,
    duration: float | None,
    steps: int,
    times: Sequence[float] | np.ndarray | None,
    event_rows: bool = False,
    beside: Prepared | None = None,
    switch_at: Sequence[float] | np.ndarray = (),
) -> Solution:
    """Return a sweep; see :meth:`mbsd.mechanism.Mechanism.sweep`.

    ``beside`` is a prepared mechanism that differs in numbers alone.
    """
    grid = sweep_times(m, duration, steps, times)
    switches = switch_times(m, switch_at)
    ready = _ready(m, beside, float(grid[0]), float(grid[-1]))
    march = march_along(ready, grid, switches)
    if duration is None and times is None and m.drivers and not len(switches):
        whole = _whole_period(m, ready, march, float(grid[-1]))
        if whole is not None:
            grid = equal_times(m, whole, steps)
            ready = prepare(m, 0.0, whole)
            march = march_along(ready, grid)
        cycles = whole_cycles(ready.packed, march.q[0], march.q[-1])
        if cycles > 1:
            grid = equal_times(m, cycles * float(grid[-1]), steps)
            ready = prepare(m, 0.0, float(grid[-1]))
            march = march_along(ready, grid)
    asked = _beside_jumps(ready, grid, march) if event_rows else None
    if asked is not None:
        grid = asked.solved
        march = march_along(ready, grid, switches)
    packed = ready.packed
    if m.contacts or limits_of(packed):
        inner, poses = march.closely()
        refuse_passed(packed, inner, poses, smooth=True)
        refuse_passed_contacts(m, packed, inner, poses)
    if "span" in packed.specials.names:
        refuse_left_wheels(packed, *march.closely())
    if CurveBranches(packed).rows:
        refuse_jumps(packed, *march.closely())
    check_pistons(packed, grid, march.q)
    sol = _solution(m, ready, grid, march)
    return sol if asked is None else asked.rows(sol)


def _solution(m: Model, ready: Prepared, grid: np.ndarray, march: March) -> Solution:
    """Return the motion at the times (s) of ``grid`` (T,) with its efforts.

    Efforts near change points come from poses beside.
    """
    packed = ready.packed
    sides = [(passage, side) for passage in march.passages for side in sides_of(passage, grid)]
    if not sides:
        q, v, a, drives = march.q, march.v, march.a, march.drives
        states = _states(ready, march, grid, q)
        loads = inverse_dynamics(ready, grid, drives, q, v, a, states)
        return _named(m, ready, march, (grid, drives, q, v, a), loads, states)
    every = np.union1d(grid, np.concatenate([side.nodes for _, side in sides]))
    parts = [np.zeros((len(every), march.q.shape[1])) for _ in range(3)]
    asked, solved = np.isin(every, grid), np.ones(len(every), bool)
    for part, source in zip(parts, (march.q, march.v, march.a), strict=True):
        part[asked] = source
    for passage, side in sides:
        new = np.setdiff1d(side.nodes, grid)
        for part, source in zip(parts, passage.motion(new), strict=True):
            part[np.searchsorted(every, new)] = source
        solved[np.searchsorted(every, side.rows)] = False
    drives, states = ready.packed.drives(every), _states(ready, march, every, parts[0])
    q, v, a = (part[solved] for part in parts)
    known = None if states is None else states[solved]
    loads = inverse_dynamics(ready, every[solved], drives[solved], q, v, a, known)
    lam, wrench = _spread(loads.lam, solved), _spread(loads.wrench, solved)
    approached = None if loads.approached is None else _spread(loads.approached, solved)
    beside = []
    for passage, side in sides:
        nodes, rows = np.searchsorted(every, side.nodes), np.searchsorted(every, side.rows)
        factor = determinant_of(passage, np.append(side.nodes, side.rows))
        scales = packed.row_scale(), packed.size
        lam[rows], wrench[rows] = efforts_beside(side, factor, lam[nodes], wrench[nodes], *scales)
        if approached is not None and len(nodes):
            approached[rows] = approached[nodes[0]]
        beside.append((side, factor))
    efforts = Efforts(lam, wrench, loads.residuals, approached)
    whole = _named(m, ready, march, (every, drives, *parts), efforts, states)
    motions = [Beside(side, factor, whole.only(np.isin(every, side.nodes))) for side, factor in beside]
    return replace(whole.only(asked), beside=tuple(motions))


def _named(
    m: Model, ready: Prepared, march: March, motion: tuple[np.ndarray, ...], loads: Efforts, states: np.ndarray | None
) -> Solution:
    """Return the results by name of a ``motion``: times (T,), drives, q, v and a (T, 3 nb)."""
    grid, drives, q, v, a = motion
    shape = (len(grid), -1, 3)
    return Solution(
        mechanism=m,
        packed=ready.packed,
        t=grid,
        q=q.reshape(shape),
        v=v.reshape(shape),
        a=a.reshape(shape),
        wrench=loads.wrench,
        lam=loads.lam,
        approached=loads.approached,
        states=states,
        drives=drives,
        margin=partial(singularity_margin, ready.packed, ready.sequence.rows, drives, q),
        stats=Stats(*(float(r) for r in loads.residuals), steps=len(march.q), inserted_steps=march.steps.inserted),
        mobility=ready.mobility,
        route=ready.route if march.closed else "Newton-Raphson",
    )


def _states(ready: Prepared, march: March, times: np.ndarray, q: np.ndarray) -> np.ndarray | None:
    """Return (T, n) states of forces (SI) along the motion, None without any. Raises SimulationError.

    ``q`` (T, 3 nb): poses at ``times`` (T,) (s), which may be far from each other.
    """
    if not with_states(ready.packed).states:
        return None

    def solve(every: np.ndarray) -> Motion:
        motion = march_along(ready, every, march.switch_at)
        return motion.q, motion.v, motion.a

    close = refine_times(ready.packed, times, solve)
    states = states_along(ready.packed, close, *solve(close))
    assert states is not None
    states = states[np.searchsorted(close, times)]
    check_states(ready.packed, times, q, states)
    return states


def _spread(values: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return (T, ...) with ``values`` at ``rows`` (T,), NaN elsewhere."""
    out = np.full((len(rows), *values.shape[1:]), np.nan)
    out[rows] = values
    return out


def switch_times(m: Model, times: Sequence[float] | np.ndarray) -> np.ndarray:
    """Return (n,) times (s) at which a motion is to switch. Raises ModelError unless they are finite."""
    if isinstance(times, tuple) and not times:
        return np.zeros(0)
    switches = number_array(f"{m.name}: switch_at", times)
    if switches.ndim != 1:
        raise ModelError(f"{m.name}: switch_at is {shown(times)}; it must be a list of times (s) of change points")
    return switches


def _ready(m: Model, beside: Prepared | None, start: float, end: float) -> Prepared:
    return prepare(m, start, end) if beside is None else prepare_beside(m, beside, start, end)


def _beside_jumps(ready: Prepared, grid: np.ndarray, march: March) -> Asked | None:
    """Return the times (s) of ``grid`` and those beside what jumps; None where nothing does."""
    packed, start, end = ready.packed, float(grid[0]), float(grid[-1])
    if not end > start:
        return None

    def motion(times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        every = np.union1d(grid, times)
        march, rows = march_along(ready, every), np.searchsorted(every, times)
        return march.q[rows], march.v[rows]

    jumps, beside = jump_times(packed, compiled_laws(packed, start, end), start, end), reach_beside(start, end)
    rows = [(t - beside, t + beside, names) for t, names in jumps.items()]
    changes = phase_changes(packed, grid, (march.q, march.v, march.a), motion)
    rows += [(min(a, b - beside), max(b, a + beside), (name,)) for a, b, name in changes]
    return jumps_of(rows).among(grid) if rows else None


def sweep_times(m: Model, duration: float | None, steps: int, times: Sequence[float] | np.ndarray | None) -> np.ndarray:
    """Return (T,) rising times (s) of a sweep. Raises ModelError."""
    if times is not None:
        return rising_times(m, times, 1)
    if duration is None:
        duration = _law_duration(m)
    return equal_times(m, duration, steps)


def _law_duration(m: Model) -> float:
    """Return the common period of the laws (s), else the longest of theirs. Raises ModelError without."""
    if not m.drivers:
        return 1.0  # mobility will name the missing driver
    common = common_period(m.drivers.values())
    if common is not None:
        return common
    periods = {name: d.motion.period for name, d in m.drivers.items() if d.motion is not None and d.motion.period}
    if not periods:
        raise ModelError(f"{m.name}: no driver repeats, so there is no natural duration; say sweep(duration=...)")
    return max(periods.values())


def _whole_period(m: Model, ready: Prepared, march: March, duration: float) -> float | None:
    """Return the mechanism's period (s) if it is longer than the motion just swept, else None.

    Warns where no pose repeats.
    """
    shape = (len(march.q), -1, 3)
    q, v, a = (part.reshape(shape) for part in (march.q, march.v, march.a))
    if returned(((q[0], v[0], a[0]), (q[-1], v[-1], a[-1]))):
        return None
    common = common_period(m.drivers.values())
    if common is None:
        why = "the laws of its drivers have no common period"
    else:
        period = repetition(m, common, ready).period
        if period is not None:
            return period
        why = f"its bodies are not back within {MOST_TURNS} times {common:.6g} s, after which its drivers repeat"
    warn(
        f"{m.name}: {why}, so the motion does not repeat, and {duration:.6g} s of it are swept; "
        "say sweep(duration=...) for more or less",
        ModelWarning,
    )
    return None
