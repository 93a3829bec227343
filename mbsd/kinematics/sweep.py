"""A driven motion from start to end, as a Solution."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from mbsd.arrays.chambers import check_pistons, phase_changes, whole_cycles
from mbsd.arrays.curve_branches import CurveBranches
from mbsd.arrays.law_jumps import jump_times, reach_beside
from mbsd.arrays.laws import compiled_laws
from mbsd.base.arguments import number_array
from mbsd.base.errors import ModelError, ModelWarning
from mbsd.base.shown import shown
from mbsd.base.warn import warn
from mbsd.kinematics.efforts_beside import determinant_of, fill_beside, sides_of
from mbsd.kinematics.limits.closed_contacts import refuse_passed_contacts
from mbsd.kinematics.limits.curve_jumps import refuse_jumps
from mbsd.kinematics.limits.joints import limits_of, refuse_passed
from mbsd.kinematics.march import March, march_along
from mbsd.kinematics.multipliers import Efforts, inverse_dynamics, singularity_margin
from mbsd.kinematics.period import MOST_TURNS, common_period, repetition
from mbsd.kinematics.prepare import prepare, prepare_beside
from mbsd.kinematics.prepared import Prepared
from mbsd.kinematics.states_along import states_along
from mbsd.model.mechanism import Model
from mbsd.model.output_times import equal_times, rising_times
from mbsd.results.jump_rows import Asked, jumps_of
from mbsd.results.returned import returned
from mbsd.results.solution import Solution
from mbsd.results.states import check_states
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
    """See :meth:`mbsd.mechanism.Mechanism.sweep`; ``beside``: a mechanism made ready that differs in numbers alone."""
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
    q, v, a, packed = march.q, march.v, march.a, ready.packed
    drives = march.drives
    if m.contacts or limits_of(packed):
        inner, poses = march.closely()
        refuse_passed(packed, inner, poses, smooth=True)
        refuse_passed_contacts(m, packed, inner, poses)
    if CurveBranches(packed).rows:
        refuse_jumps(packed, *march.closely())
    check_pistons(packed, grid, q)
    loads, states = _loads(ready, grid, march)
    shape = (len(grid), -1, 3)
    sol = Solution(
        mechanism=m,
        packed=packed,
        t=grid,
        q=q.reshape(shape),
        v=v.reshape(shape),
        a=a.reshape(shape),
        wrench=loads.wrench,
        lam=loads.lam,
        approached=loads.approached,
        states=states,
        drives=drives,
        margin=partial(singularity_margin, packed, ready.sequence.rows, drives, q),
        stats=Stats(*(float(r) for r in loads.residuals), steps=len(grid), inserted_steps=march.steps.inserted),
        mobility=ready.mobility,
        route=ready.route if march.closed else "Newton-Raphson",
    )
    return sol if asked is None else asked.rows(sol)


def _loads(ready: Prepared, grid: np.ndarray, march: March) -> tuple[Efforts, np.ndarray | None]:
    """Efforts, and states of forces (T, n), at the times (s) of ``grid``; those near change points from poses beside."""
    packed = ready.packed
    sides = [(passage, side) for passage in march.passages for side in sides_of(passage, grid)]
    if not sides:
        states = states_along(packed, grid, march.q, march.v, march.a)
        if states is not None:
            check_states(packed, grid, march.q, states)
        return inverse_dynamics(ready, grid, march.drives, march.q, march.v, march.a, states), states
    nodes = np.concatenate([side.nodes for _, side in sides])
    every = np.union1d(grid, nodes)
    parts = [np.zeros((len(every), march.q.shape[1])) for _ in range(3)]
    known, solved = np.searchsorted(every, grid), np.ones(len(every), bool)
    for part, source in zip(parts, (march.q, march.v, march.a), strict=True):
        part[known] = source
    for passage, side in sides:
        at = np.searchsorted(every, side.nodes)
        for part, source in zip(parts, passage.motion(side.nodes), strict=True):
            part[at] = source
        solved[np.searchsorted(every, side.rows)] = False
    states = states_along(packed, every, *parts)
    if states is not None:
        check_states(packed, every, parts[0], states)
    drives = packed.drives(every)
    rows = [part[solved] for part in parts]
    found = inverse_dynamics(ready, every[solved], drives[solved], *rows, None if states is None else states[solved])
    whole = Efforts(
        *(_spread(part, solved) for part in (found.lam, found.wrench)),
        found.residuals,
        None if found.approached is None else _spread(found.approached, solved),
    )
    for passage, side in sides:
        at, to = np.searchsorted(every, side.nodes), np.searchsorted(every, side.rows)
        factor = determinant_of(passage, np.append(side.nodes, side.rows))
        fill_beside(packed, side, factor, whole.lam, whole.wrench, at, to)
        if whole.approached is not None:
            whole.approached[to] = whole.approached[at[0]]
    approached = None if whole.approached is None else whole.approached[known]
    efforts = Efforts(whole.lam[known], whole.wrench[known], found.residuals, approached)
    return efforts, None if states is None else states[known]


def _spread(values: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(T, ...) with ``values`` at ``rows`` (T,), NaN elsewhere."""
    out = np.full((len(rows), *values.shape[1:]), np.nan)
    out[rows] = values
    return out


def switch_times(m: Model, times: Sequence[float] | np.ndarray) -> np.ndarray:
    """(n,) times (s) at which a motion is to switch. Raises ModelError for what are no finite numbers."""
    if isinstance(times, tuple) and not times:
        return np.zeros(0)
    switches = number_array(f"{m.name}: switch_at", times)
    if switches.ndim != 1:
        raise ModelError(f"{m.name}: switch_at is {shown(times)}; it must be a list of times (s) of change points")
    return switches


def _ready(m: Model, beside: Prepared | None, start: float, end: float) -> Prepared:
    return prepare(m, start, end) if beside is None else prepare_beside(m, beside, start, end)


def _beside_jumps(ready: Prepared, grid: np.ndarray, march: March) -> Asked | None:
    """The times (s) of ``grid`` and those beside what jumps; None where nothing does."""
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
    """(T,) rising times (s) of a sweep. Raises ModelError."""
    if times is not None:
        return rising_times(m, times, 1)
    if duration is None:
        duration = _law_duration(m)
    return equal_times(m, duration, steps)


def _law_duration(m: Model) -> float:
    """The common period of the laws (s), or the longest of theirs where there is none. Raises ModelError for none."""
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
    """The mechanism's period (s) where it is longer than the one just swept; None where that one serves.

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
