"""From mechanism.py to a solved motion: build(), and motion() or what follows from the model.

Without ``motion(m, p)`` a mechanism whose drivers fix every freedom is swept over one period, any other is simulated
from its start. Two numbers beside build() say more:

    DURATION = 2.0    how long the motion is (s); a simulation needs it, a sweep takes its period without
    STEPS = 600       number of equal output steps

A mechanism of mbsd.spatial is solved the same way (space/running.py).
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from mechanisms.stages.loading import loading
from mechanisms.stages.loading.loading import refuse_arguments
from mechanisms.stages.solve.space.running import is_in_space, natural_run
from shared.contract.quantity import counted
from shared.stage import console
from shared.stage.errors import UserError
from shared.stage.paths import owner_of, shown_file

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution


SWEEP_STEPS = 360
"""Steps of one turn of the drivers in a sweep whose mechanism.py has no STEPS; more where the motion needs them."""
FEWEST, MOST, RATE = 360, 7200, 120.0
"""Steps of a simulation whose mechanism.py has no STEPS: so many a second, within these, more where it needs them."""


def build(name: str, module: Any, p: Any) -> Mechanism:
    """Return the model of ``build(p)`` in ``module``; that of a variant has the variant's name.

    Raises UserError unless it is a Mechanism called as its folder.
    """
    from mbsd import Mechanism

    refuse_arguments(_file(name), module.build, p)
    with loading.author_code(name):
        m = module.build(p)
    if not (isinstance(m, Mechanism) or is_in_space(m)):
        raise UserError(f"{_file(name)}: build() returned {_kind(m)}, not a Mechanism; does it end with 'return m'?")
    folder = owner_of(name)
    if m.name != folder:
        raise UserError(
            f"{_file(name)}: build() calls its mechanism '{m.name}', but the folder is {folder}, and files are found "
            f'by the folder\'s name; write Mechanism("{folder}")'
        )
    m.name = name
    return m


def model_of(name: str) -> tuple[Mechanism, Any, Any]:
    """Return the model of mechanism ``name``, the module of its mechanism.py, and its Params."""
    module, p = loading.load(name, "mechanism"), loading.params(name)
    return build(name, module, p), module, p


def motion_of(name: str, module: Any, m: Mechanism, p: Any) -> Solution:
    """Return the motion of ``m`` as mechanism.py asks for it. Raises UserError.

    Warnings of the solver become lines.
    """
    from mbsd import MechanismError
    from mbsd.results.solution import Solution

    motion: Any = getattr(module, "motion", None)
    if motion:
        refuse_arguments(_file(name), motion, m, p)
    try:
        with loading.author_code(name), model_warnings_said():
            solution = motion(m, p) if motion else _natural(name, module, m)
    except MechanismError as error:
        raise UserError(str(error)) from error
    if not (isinstance(solution, Solution) or is_in_space(solution)):
        raise UserError(
            f"{_file(name)}: motion() returned {_kind(solution)}; it must return a Solution, "
            "as m.sweep() and m.simulate() do"
        )
    _refuse_other(name, m, solution.mechanism)
    if not is_in_space(m) and not _tell_blurred_impacts(name, solution):
        _tell_long_steps(name, module, solution)
    solution.mechanism.name = name  # where motion() built the mechanism of a variant anew
    return solution


def _natural(name: str, module: Any, m: Mechanism) -> Solution:
    """Return the sweep or simulation that the model asks for."""
    duration = _positive(name, module, "DURATION", "a number of seconds, as in DURATION = 2.0")
    steps = _positive(name, module, "STEPS", "a whole number of steps, as in STEPS = 600")
    if steps is not None and steps != int(steps):
        raise UserError(f"{_file(name)}: STEPS is {steps:g}; it must be a whole number of steps, as in STEPS = 600")
    if is_in_space(m):
        in_space: Any = m
        return natural_run(in_space, duration, None if steps is None else int(steps), _file(name))  # pyright: ignore[reportReturnType]
    free = m.mobility().dof - len(m.drivers)
    if free <= 0:
        if steps is not None:
            return m.sweep(duration, int(steps), event_rows=True)

        return refined_sweep(m.sweep(duration, _steps_of(m, duration)))
    if duration is None:
        freedoms = f"{counted(free, 'degree')} of freedom {'is' if free == 1 else 'are'}"
        raise UserError(
            f"{name}: {freedoms} not driven, so the motion is simulated, but its duration is missing. "
            f"Write DURATION = 2.0 (seconds) beside build() in {_file(name)}, or add a driver, "
            "such as m.drive_angle(...)"
        )
    if steps is not None:
        return m.simulate(duration, int(steps), event_rows=True)

    return simulated_closely(m, duration, min(max(FEWEST, math.ceil(RATE * duration)), MOST))


def _steps_of(m: Mechanism, duration: float | None) -> int:
    """Return steps of a sweep: so many for each turn of its drivers, by default of the whole period."""
    from mbsd.kinematics.period import common_period

    whole, common = duration or m.period(), common_period(m.drivers.values())
    if whole is None or common is None:
        return SWEEP_STEPS
    return max(SWEEP_STEPS, min(round(SWEEP_STEPS * whole / common), MOST))


def _positive(name: str, module: Any, constant: str, form: str) -> float | None:
    """Return a constant beside build(), or None where there is none.

    Raises UserError unless it is a positive number.
    """
    value = loading.constant(name, module, constant)
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < math.inf:
        raise UserError(f"{_file(name)}: {constant} is {value!r}; it must be {form}")
    return float(value)


def _refuse_other(name: str, m: Mechanism, solved: Any) -> None:
    """Raise UserError unless motion() solved the model or a variant of it, with the same name and bodies."""
    if solved is not m and (solved.name not in (name, owner_of(name)) or set(solved.bodies) != set(m.bodies)):
        raise UserError(
            f"{_file(name)}: motion() solved '{solved.name}' with the bodies {', '.join(solved.bodies)}; solve the "
            f"mechanism it is given, '{name}', or a variant with the same bodies"
        )


def _tell_blurred_impacts(name: str, solution: Solution) -> bool:
    """Say that impacts lie between rows, and return True if they do.

    Plots and films would show them as something smooth.
    """
    shared = {float(time) for time in solution.t[1:][solution.t[1:] == solution.t[:-1]]}
    lost = [event for event in solution.events if event.what == "impact" and event.time not in shared]
    if lost:
        console.warn(
            "solve",
            f"{name}: {counted(len(lost), 'impact')}, the first '{lost[0].name}' at {lost[0].time:.6g} s, without rows "
            "right before and after, shown as something smooth in plots and films; write m.simulate(..., "
            "event_rows=True) in motion()",
        )
    return bool(lost)


def _tell_long_steps(name: str, module: Any, solution: Solution) -> None:
    """Say that rows of a simulation are too far apart for fast motion, so that proofs may fail there."""

    long = [] if solution.work is None else doubted_steps(solution)
    if len(long):
        own = "motion()" if hasattr(module, "motion") else "STEPS"
        chosen = hasattr(module, "motion") or loading.constant(name, module, "STEPS") is not None
        remedy = f"leave out {own}, so that rows are added there, or ask for more steps" if chosen else "end it earlier"
        steps = f"{counted(len(long), 'step')} {'is' if len(long) == 1 else 'are'}"
        console.warn(
            "solve",
            f"{name}: {steps} too long for the fastest bodies, first at t = {solution.t[long[0]]:.6g} s: plots and "
            f"films may stray from the motion there, and clearances may not be proven; {remedy}",
        )


@contextmanager
def model_warnings_said() -> Iterator[None]:
    """Say what the solver warns of in a line each, without the place in this file where it was called."""
    from mbsd import ModelWarning

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", ModelWarning)
        try:
            yield
        finally:
            for warning in caught:
                if issubclass(warning.category, ModelWarning):
                    console.warn("solve", str(warning.message))
    for warning in caught:
        if not issubclass(warning.category, ModelWarning):
            warnings.warn_explicit(warning.message, warning.category, warning.filename, warning.lineno)


def _file(name: str) -> str:
    return shown_file(name)


def _kind(value: object) -> str:
    return "None" if value is None else f"a {type(value).__name__}"


# Refinement of output times, until the motion between two of them is the quintic that plots, clearance and film use.
#
#     at the middle of a step h   q = (q0 + q1) / 2 + 5 h / 32 (v0 - v1) + h^2 / 64 (a0 + a1)
#
# That is compared with the simulation itself at these middles; steps that differ are divided, and it is simulated
# again. Stiff contacts and short pulses need it: for milliseconds their accelerations say nothing about the rest of a
# step.
#
# A motion that snaps through needs more. The proof of clearance knows rows alone, and trusts a step by how far the
# quintic is from the cubic through places and rates (clearance/path.py), with h the step, at their middle control
# points:
#
#     3 (q0 - q1) / 10 + h (2 v0 + v1) / 10 + h^2 a0 / 20      and the same from the other end
#
# so that steps in which these are far apart are divided, too.

CLOSE = 2e-5
"""Largest difference, in sizes of the mechanism (turned bodies count by their angle times that size)."""
PROVABLE = 5e-4
"""Doubt of the proof of clearance that a step may leave, in the same sizes: a third of the gap by which a block clears
its rail in automatic parts."""
DOUBT = 3.0 * 0.625
"""Factor on that difference of control points, as in the proof."""
PARTS = 4
"""Into which a step is divided at once."""
ROUNDS = 4
MOST_ROWS = 20_000
"""Times that a motion has at the most."""


def simulated_closely(m: Mechanism, duration: float, steps: int) -> Solution:
    """Run ``m.simulate`` with both rows of events, in ``steps`` equal steps and more where needed."""
    times = np.linspace(0.0, duration, steps + 1)
    solution = m.simulate(times=times, event_rows=True)
    for _ in range(ROUNDS):
        closer = np.union1d(times, _inner(solution.t, len(times), *coarse_steps(solution)))
        if len(closer) == len(times):
            break
        times = closer
        solution = m.simulate(times=times, event_rows=True)
    return solution


def refined_sweep(solution: Solution) -> Solution:
    """Return the same sweep, with both rows of what jumps and at more times where the motion needs them."""
    both = solution.mechanism.sweep(times=solution.t, event_rows=True)
    times = np.unique(both.t)
    closer = closer_times(solution.mechanism, times)
    if len(closer) > len(times):
        return solution.mechanism.sweep(times=closer, event_rows=True)
    return both if len(both.t) > len(solution.t) else solution


def swept_closely(m: Mechanism, times: np.ndarray) -> Solution:
    """``m.sweep`` at ``times`` (s) and at more where the motion needs them."""
    return m.sweep(times=closer_times(m, times))


def closer_times(m: Mechanism, times: np.ndarray) -> np.ndarray:
    """Return times (s) with more where the sweep needs them: where a link flies past a dead point."""
    for _ in range(2 * ROUNDS):
        middles = (times[:-1] + times[1:]) / 2
        finer = m.sweep(times=np.sort(np.concatenate([times, middles])), event_rows=True)
        first = np.searchsorted(finer.t, times[:-1], side="right") - 1
        last, middle = np.searchsorted(finer.t, times[1:]), np.searchsorted(finer.t, middles)
        far = _far(finer, first, last, finer.q[middle])
        coarse = np.flatnonzero(far > 1.0)
        closer = np.union1d(times, _inner(times, len(times), coarse, far[coarse]))
        if len(closer) == len(times):
            break
        times = closer
    return times


def _inner(times: np.ndarray, count: int, coarse: np.ndarray, far: np.ndarray) -> np.ndarray:
    """Return times (s) that divide the steps after rows ``coarse``.

    Of too many, those that are ``far`` most are divided.

    If they are too many, those with the largest ``far`` remain. ``count``: how many times there are already.
    """
    room = max(MOST_ROWS - count, 0) // (PARTS - 1)
    coarse = coarse[np.argsort(-far, kind="stable")[:room]]
    starts, ends = times[coarse], times[coarse + 1]
    return (starts[:, None] + (ends - starts)[:, None] * np.arange(1, PARTS) / PARTS).ravel()


def coarse_steps(solution: Solution) -> tuple[np.ndarray, np.ndarray]:
    """Return rows after which the quintic leaves the motion, and how far, 1 being what may be."""
    steps = _steps(solution)
    far = _far(solution, steps, steps + 1, solution.at((solution.t[steps] + solution.t[steps + 1]) / 2).q)
    return steps[far > 1.0], far[far > 1.0]


def doubted_steps(solution: Solution) -> np.ndarray:
    """Return rows after which the proof of clearance doubts the motion, as far as rows show it."""
    steps = _steps(solution)
    return steps[_doubt(solution, steps, steps + 1) > 1.0]


def _steps(solution: Solution) -> np.ndarray:
    """Return (n,) rows at which a step begins."""
    t = solution.t
    return np.flatnonzero(np.diff(t) > 1e-9 * (t[-1] - t[0]))


def _far(solution: Solution, first: np.ndarray, last: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """Return (n,) how far the quintic between two rows is from the motion, or doubted.

    ``middle`` (n, bodies, 3) is half way.

    ``middle`` (n, bodies, 3) is the motion half way; also counted is how far it is in doubt.
    """
    h, size = (solution.t[last] - solution.t[first])[:, None, None], solution.packed.size
    q, v, a = solution.q, solution.v, solution.a
    between = (q[first] + q[last]) / 2 + 5 / 32 * h * (v[first] - v[last]) + h * h / 64 * (a[first] + a[last])
    gap = np.abs(between - middle) * np.array([1.0, 1.0, size])
    return np.maximum(gap.max(axis=(1, 2)) / (CLOSE * size), _doubt(solution, first, last))


def _doubt(solution: Solution, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Return (n,) how far the quintic is from the cubic between rows, in parts of what may be doubted."""
    h, size = (solution.t[last] - solution.t[first])[:, None, None], solution.packed.size
    rise = 0.3 * (solution.q[last] - solution.q[first])
    v0, v1 = h * solution.v[first], h * solution.v[last]
    begins = (2 * v0 + v1) / 10 + h * h * solution.a[first] / 20 - rise
    ends = (v0 + 2 * v1) / 10 - h * h * solution.a[last] / 20 - rise
    gap = DOUBT * np.maximum(np.abs(begins), np.abs(ends)) * np.array([1.0, 1.0, size])
    return gap.max(axis=(1, 2)) / (PROVABLE * size)
