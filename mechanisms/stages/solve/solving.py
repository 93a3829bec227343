"""From mechanism.py to a solved motion: build(), and motion() or what follows from the model.

Without ``motion(m, p)`` a mechanism whose drivers fix every freedom is swept over one period, any other is simulated
from its start. Two numbers beside build() say more:

    DURATION = 2.0    how long the motion is (s); a simulation needs it, a sweep takes its period without
    STEPS = 600       number of equal output steps
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from mechanisms.stages.loading import loading
from mechanisms.stages.loading.loading import refuse_arguments
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
    if not isinstance(m, Mechanism):
        raise UserError(f"{_file(name)}: build() returned {_kind(m)}, not a Mechanism; does it end with 'return m'?")
    folder = owner_of(name)
    if m.name != folder:
        raise UserError(
            f"{_file(name)}: build() calls its mechanism '{m.name}', but the folder is {folder}, and files are found "
            f'by the folder\'s name; write Mechanism("{folder}")'
        )
    m.name = name
    return m


def motion_of(name: str, module: Any, m: Mechanism, p: Any) -> Solution:
    """Return the motion of ``m`` as mechanism.py asks for it. Raises UserError; warnings of the solver become lines."""
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
    if not isinstance(solution, Solution):
        raise UserError(
            f"{_file(name)}: motion() returned {_kind(solution)}; it must return a Solution, "
            "as m.sweep() and m.simulate() do"
        )
    _refuse_other(name, m, solution.mechanism)
    if not _tell_blurred_impacts(name, solution):
        _tell_long_steps(name, module, solution)
    solution.mechanism.name = name  # where motion() built the mechanism of a variant anew
    return solution


def _natural(name: str, module: Any, m: Mechanism) -> Solution:
    """Return the sweep or simulation that the model asks for."""
    duration = _positive(name, module, "DURATION", "a number of seconds, as in DURATION = 2.0")
    steps = _positive(name, module, "STEPS", "a whole number of steps, as in STEPS = 600")
    if steps is not None and steps != int(steps):
        raise UserError(f"{_file(name)}: STEPS is {steps:g}; it must be a whole number of steps, as in STEPS = 600")
    free = m.mobility().dof - len(m.drivers)
    if free <= 0:
        if steps is not None:
            return m.sweep(duration, int(steps), event_rows=True)

        from mechanisms.stages.solve.refinement import refined_sweep

        return refined_sweep(m.sweep(duration, _steps_of(m, duration)))
    if duration is None:
        freedoms = f"{counted(free, 'degree')} of freedom {'is' if free == 1 else 'are'}"
        raise UserError(
            f"{name}: {freedoms} not driven, so forces move it and the motion is simulated, but how long is not said; "
            f"write DURATION = 2.0 (seconds) beside build() in {_file(name)}, or add a driver, "
            "such as m.drive_angle(...)"
        )
    if steps is not None:
        return m.simulate(duration, int(steps), event_rows=True)

    from mechanisms.stages.solve.refinement import simulated_closely

    return simulated_closely(m, duration, min(max(FEWEST, math.ceil(RATE * duration)), MOST))


def _steps_of(m: Mechanism, duration: float | None) -> int:
    """Return steps of a sweep: so many for each turn of its drivers, of the whole period where no duration is given."""
    from mbsd.kinematics.period import common_period

    whole, common = duration or m.period(), common_period(m.drivers.values())
    if whole is None or common is None:
        return SWEEP_STEPS
    return max(SWEEP_STEPS, min(round(SWEEP_STEPS * whole / common), MOST))


def _positive(name: str, module: Any, constant: str, form: str) -> float | None:
    """Return a constant beside build(), or None where there is none. Raises UserError unless it is a positive
    number.
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
    """Say that impacts lie between rows, so that plots and films would show them as something smooth; whether so."""
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
    """Say that rows of a simulation are too far apart for how fast something moves, so that proofs may fail there."""

    from mechanisms.stages.solve.refinement import doubted_steps

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
