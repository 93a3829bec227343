"""Tasks: which dimensions of a mechanism vary, how its copies are solved, where its pins lie."""

from __future__ import annotations

import inspect
import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from mbsd.base.arguments import whole_number
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.dynamics.measures.kinds import Measure
from mbsd.kinematics.batch import MOST_THREADS
from mbsd.model.mechanism import Model
from mbsd.tolerancing.dimensions.dimension import Dimension, LoosePlay
from mbsd.tolerancing.dimensions.named import dimensions_of, numbers_of, pushed
from mbsd.tolerancing.machines.batched import Batched, push_directions, serves
from mbsd.tolerancing.machines.one_by_one import Answers, Machines, OneByOne, Simulated, computed, swept
from mbsd.tolerancing.machines.results import OfSolution, called, number_of, result_given

WAYS = ("auto", "batch", "sweep", "simulate")


@dataclass
class Task:
    """A task of evaluation."""

    owner: str
    dimensions: list[Dimension]
    machines: Machines
    nominal: float
    notes: list[str] = field(default_factory=list)


def task_of(m: Any, sizes: Any, result: Any, duration: float | None, steps: int, way: str, threads: int | None) -> Task:
    """Return the task of a mechanism; see :func:`mbsd.tolerances`. Raises ModelError."""
    if way not in WAYS:
        raise ModelError(f"{m.name}: tolerances: {no_such('way', way, WAYS)}")
    if threads is not None and whole_number(f"{m.name}: tolerances: threads", threads) > MOST_THREADS:
        raise ModelError(f"{m.name}: tolerances: threads is {threads}; it must be {MOST_THREADS} at most")
    result = result_given(m.name, result)
    dimensions = dimensions_of(m, sizes)
    _refuse_twice(m.name, dimensions)
    free = m.mobility().dof - len(m.drivers)
    if way == "simulate" or (way == "auto" and free > 0):
        return _simulated(m, dimensions, result, duration, steps, threads)
    if free > 0:
        freedoms = "1 degree of freedom is" if free == 1 else f"{free} degrees of freedom are"
        raise ModelError(f"{m.name}: tolerances: {freedoms} not driven; add a driver, or take way='simulate'")
    return _driven(m, dimensions, result, duration, steps, way, threads)


def _driven(
    m: Any, dimensions: list[Dimension], result: Any, duration: float | None, steps: int, way: str, threads: int | None
) -> Task:
    from mbsd.kinematics.prepared import prepare
    from mbsd.kinematics.sweep import sweep, sweep_times

    grid = sweep_times(m, duration, steps, None)
    if isinstance(result, Measure):
        result.check(f"{m.name}: tolerances: result", grid)
    ideal = sweep(m, None, 1, grid)
    if isinstance(result, Measure):
        OfSolution(m, result)(ideal)  # names that there are not are refused by the names that there are
    columns = [column for d in dimensions for column in d.columns]
    can = serves(m, columns, result, prepare(m, float(grid[0]), float(grid[-1])))
    if way == "batch" and not can:
        raise ModelError(
            f"{m.name}: tolerances: these mechanisms cannot be swept all at once; take way='sweep'. All at once takes "
            "driven bodies and dyads, lengths, positions and play, and results x, y or theta of bodies, x, y of traces"
        )
    pins = [d for d in dimensions if isinstance(d, LoosePlay)]
    if way == "sweep" or not can:
        for pin in pins:
            if pin.clearance.direction == "reaction":
                raise ModelError(
                    f"{m.name}: tolerances: the gap of '{pin.label}' follows the reaction where machines are "
                    "swept all at once, and these are not; take Clearance(..., direction='any')"
                )
        machines: Machines = swept(m, columns, result, grid)
        return Task(m.name, dimensions, machines, alone(m.name, machines, columns), _notes([], pins))
    pushes = push_directions(ideal, [pin.label for pin in pins if pin.clearance.direction != "any"])
    dimensions = [_settled(m.name, d, pushes) for d in dimensions]
    columns = [column for d in dimensions for column in d.columns]
    known = {name: along for name, along in pushes.items() if along is not None}
    poses = np.ascontiguousarray(ideal.q.reshape(len(grid), -1))
    machines = Batched(m, columns, result, grid, known, poses, threads)
    loose = [pin for pin in pins if pin.label not in known]
    return Task(m.name, dimensions, machines, alone(m.name, machines, columns), _notes(list(known), loose))


def _settled(owner: str, dimension: Dimension, pushes: Mapping[str, np.ndarray | None]) -> Dimension:
    """A pin lies where the reaction pushes it, if it carries any."""
    if not isinstance(dimension, LoosePlay) or dimension.label not in pushes:
        return dimension
    if pushes[dimension.label] is not None:
        return pushed(dimension)
    if dimension.clearance.direction == "reaction":
        raise ModelError(
            f"{owner}: tolerances: pin '{dimension.label}' carries no force, so its gap has no direction; give "
            "masses or forces, or take Clearance(..., direction='any')"
        )
    return dimension


def _notes(known: Sequence[str], loose: Sequence[Any]) -> list[str]:
    out = [f"gap along the reaction: {', '.join(known)}"] if known else []
    return out + ([f"gap in any direction: {', '.join(pin.label for pin in loose)}"] if loose else [])


def alone(owner: str, machines: Machines, columns: Sequence[Any]) -> float:
    """The result of the mechanism as it is given. Raises ModelError where it has none."""
    if isinstance(machines, OneByOne):
        value = machines.evaluate(np.zeros(len(columns)))
        answers = Answers(np.array([value]))
    else:
        answers = machines(np.zeros((1, len(columns))))
    if np.isfinite(answers.values[0]):
        return float(answers.values[0])
    reasons = ", ".join(answers.failures) or "the result is no number"
    raise ModelError(f"{owner}: tolerances: the machine as it is given has no result: {reasons}")


def _simulated(
    m: Any, dimensions: list[Dimension], result: Any, duration: float | None, steps: int, threads: int | None
) -> Task:
    if duration is None:
        raise ModelError(f"{m.name}: tolerances: it is simulated, but how long is not given; say duration=... (s)")
    if isinstance(result, Measure):
        result.check(f"{m.name}: tolerances: result", np.linspace(0.0, duration, steps + 1))
    columns = [column for d in dimensions for column in d.columns]
    options = {"duration": duration, "steps": steps, "threads": threads}
    machines = Simulated(m, columns, result, options)
    return Task(m.name, dimensions, machines, alone(m.name, machines, columns))


def _refuse_twice(owner: str, dimensions: Sequence[Dimension]) -> None:
    """Raise ModelError where a number is named twice, as by "crank" and {"crank": {"length": ...}}."""
    labels = Counter(dimension.label for dimension in dimensions if not isinstance(dimension, LoosePlay))
    twice = next((label for label, times in labels.items() if times > 1), None)
    if twice is not None:
        raise ModelError(f"{owner}: tolerances: '{twice}' is named twice")


def function_task(function: Any, sizes: Any, result: Any, duration: float | None, steps: int) -> Task:
    """Return the task of a function with the nominal values as defaults. Raises ModelError."""
    if not callable(function) or isinstance(function, type):
        raise ModelError(
            f"tolerances: machine is {shown(function)}; give a mechanism, or a function of numbers by name with their "
            "nominal values as defaults: def gap(a=0.044, b=0.019): return a - b"
        )
    owner = getattr(function, "__name__", "function")
    nominal = _defaults(owner, function)
    dimensions = numbers_of(owner, nominal, sizes)
    if result is None:
        measure: Callable[[Any], Any] = partial(_itself, owner)
    elif isinstance(result_given(owner, result), Measure):
        measure = _swept_measure(owner, result, duration, steps)
    else:
        measure = lambda given: number_of(owner, called(owner, result, given))  # noqa: E731
    columns = [column for d in dimensions for column in d.columns]
    machines = computed(owner, function, columns, measure)
    return Task(owner, dimensions, machines, alone(owner, machines, columns))


def _itself(owner: str, given: Any) -> Any:
    """Return the result itself. Raises ModelError for a mechanism."""
    if isinstance(given, Model):
        raise ModelError(
            f"{owner}: tolerances: it gives a mechanism, and result= is missing. Give a measure of mbsd.measures, such "
            "as largest('P.y'), or a function of the mechanism that gives a number"
        )
    return given


def _defaults(owner: str, function: Callable[..., Any]) -> dict[str, float]:
    parameters = inspect.signature(function).parameters.values()
    for p in parameters:
        if p.default is p.empty and p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD):
            raise ModelError(f"{owner}: tolerances: argument '{p.name}' has no default; give its nominal value there")
    kinds = int, float, np.floating, np.integer
    return {
        p.name: float(p.default)
        for p in parameters
        if isinstance(p.default, kinds)
        and not isinstance(p.default, bool)
        and p.kind is not p.POSITIONAL_ONLY
        and math.isfinite(p.default)
    }


def _swept_measure(owner: str, result: Measure, duration: float | None, steps: int) -> Callable[[Any], float]:
    """The measure of a mechanism that a function gives."""

    def measure(given: Any) -> float:
        if not isinstance(given, Model):
            raise ModelError(
                f"{owner}: tolerances: result is a measure, so {owner} must give a mechanism; it gives {shown(given)}"
            )
        from mbsd.kinematics.sweep import sweep

        return OfSolution(given, result)(sweep(given, duration, steps, None))

    return measure
