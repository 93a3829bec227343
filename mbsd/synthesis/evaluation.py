"""Objective and conditions of an optimisation: values and derivatives for one set of numbers."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.arguments import finite_number, switch
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.base.quantity import counted
from mbsd.derivatives.driven.sweeps import SweepTangents
from mbsd.derivatives.requests import refuse_unfit
from mbsd.derivatives.sensitivities import Tangents, moves_freely, simulation_tangents, values_and_slopes
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.simulate import output_times, refuse_bad_steps
from mbsd.kinematics.sweep import sweep, sweep_times
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number, number_named, twin_of, with_values
from mbsd.results.solution import Solution
from mbsd.synthesis.variables import built, numbers_of_build, refuse_build

Span = tuple[float | None, int, Any]
"""Duration (s), steps, times."""


@dataclass
class Tried:
    """The result of one set of numbers."""

    value: float
    slope: np.ndarray
    """(k,) by the numbers."""
    conditions: list[float]
    condition_slopes: list[np.ndarray]
    solve: Callable[[], Solution] | None
    """Gives the motion; None where there is none."""
    model: Any


class Moves:
    """Numbers x (k,) in, measures and derivatives out."""

    def __init__(
        self,
        m: Model,
        bounds: Bounds,
        build: Callable[..., Any] | None,
        objective: Any,
        conditions: list[Condition],
        span: Span,
        simulated: bool | None,
        tolerance: float,
    ) -> None:
        self.m, self.bounds, self.build, self.tolerance = m, bounds, build, tolerance
        self.wishes: dict[str, Any] = {"objective": objective}
        self.wishes |= {f"condition {condition.name}": condition.what for condition in conditions}
        for label, what in self.wishes.items():
            self._refuse(label, what)
        if build is None:
            self.numbers = [number_named(m, name) for name in bounds.names]
            self.given = np.array([number.value for number in self.numbers])
            refuse_ends(m, bounds, self.numbers)
        else:
            self.given = self._defaults(build)
        self.free = moves_freely(m) if simulated is None else switch(f"{m.name}: optimise: simulate", simulated)
        duration, steps, times = span
        self.grid = output_times(m, duration, steps, times) if self.free else sweep_times(m, duration, steps, times)
        refuse_bad_steps(m, self.grid, tolerance, None)
        self._refuse_unfit()

    def __call__(self, x: np.ndarray) -> Tried:
        """Solve the motion with numbers x. Raises MechanismError where there is none."""
        model = self.model(x)
        numbers = self._numbers(model, x)
        own = {label: function_of_values(self.bounds.names, what) for label, what in self.wishes.items()}
        asked = {label: what for label, what in self.wishes.items() if own[label] is None}
        tangents = self._tangents(model, numbers, asked)
        values, slopes = values_and_slopes(model, asked, tangents, numbers)
        for label, value in values.items():
            if value.size != 1:
                raise ModelError(
                    f"{self.m.name}: optimise: {label} gives {counted(value.size, 'number')}; it must give one: "
                    "take a measure of it, such as largest(...)"
                )
        out = []
        for label, known in own.items():
            if known is not None:
                out.append(known(x))
                continue
            slope = slopes[label].reshape(-1)
            if not (np.isfinite(slope).all() and np.isfinite(values[label]).all()):
                raise ModelError(f"{self.m.name}: optimise: {label} is not finite in this motion, or has no derivative")
            out.append((float(values[label].reshape(())), slope))
        (value, slope), *rest = out
        return Tried(value, slope, [v for v, _ in rest], [s for _, s in rest], tangents.solve, model)

    def model(self, x: np.ndarray) -> Any:
        """Return the mechanism with numbers x. Raises what the author's function raises."""
        if self.build is None:
            return with_values(self.m, self.numbers, list(x))
        values = dict(zip(self.bounds.names, map(float, x), strict=True))
        return built(f"{self.m.name}: optimise", self.build, values)

    def _tangents(self, model: Model, numbers: list[Number], asked: Mapping[str, Any]) -> Tangents:
        if self.free:
            return simulation_tangents(model, self.grid, numbers, self.tolerance, asked)
        return SweepTangents(model, sweep(model, None, 1, self.grid), numbers)

    def _numbers(self, model: Model, x: np.ndarray) -> list[Number]:
        if self.build is None:
            return [number_named(model, name) for name in self.bounds.names]
        return numbers_of_build(self.bounds.names, x, self.bounds.size, self.model)

    def _defaults(self, build: Callable[..., Any]) -> np.ndarray:
        """Return (k,) defaults of the author's function, the middle of the bounds where it has none."""
        refuse_build(f"{self.m.name}: optimise", build, self.bounds.names)
        try:
            known = inspect.signature(build).parameters
        except (TypeError, ValueError):
            known = {}
        out = (self.bounds.low + self.bounds.high) / 2
        for k, name in enumerate(self.bounds.names):
            default = known[name].default if name in known else None
            if isinstance(default, int | float) and not isinstance(default, bool):
                out[k] = default
        return out

    def _refuse_unfit(self) -> None:
        """Raise ModelError for quantities that there are not, and for functions of other arguments."""
        model = self.model(np.clip(self.given, self.bounds.low, self.bounds.high))
        wishes = [
            (f"{self.m.name}: optimise: {label}", what)
            for label, what in self.wishes.items()
            if not isinstance(what, str)
        ]
        refuse_unfit(model, wishes, self.grid, self.free)

    def _refuse(self, label: str, what: Any) -> None:
        """Raise ModelError for what can give no number."""
        if isinstance(what, Measure) or (callable(what) and not isinstance(what, type)):
            return
        if isinstance(what, str):
            if what in self.bounds.names:
                return
            raise ModelError(
                f"{self.m.name}: optimise: {label} is '{what}', which is no number that varies; for a quantity take a "
                f"measure: largest('{what}') of mbsd.measures"
            )
        raise ModelError(
            f"{self.m.name}: optimise: {label} is {shown(what)}; give a measure of mbsd.measures, a function "
            "of a solution, or the name of a number that varies"
        )


def refuse_ends(m: Model, bounds: Bounds, numbers: Sequence[Number]) -> None:
    """Raise ModelError for two names of one number, and for bounds that the mechanism rejects.

    Bounds are tried at their ends.
    """
    for k, number in enumerate(numbers):
        for end in (bounds.low[k], bounds.high[k]):
            try:
                other = with_values(m, [number], [float(end)])
            except ModelError as error:
                said = str(error).removeprefix(f"{m.name}: ")
                raise ModelError(
                    f"{m.name}: optimise: '{number.name}' may be from {bounds.low[k]:g} to {bounds.high[k]:g}, and the "
                    f"mechanism refuses {end:g}: {said}"
                ) from error
            if end == number.value:
                continue
            twin = twin_of(number, other, float(end), numbers[k + 1 :])
            if twin is not None:
                raise ModelError(
                    f"{m.name}: optimise: '{number.name}' and '{twin.name}' are the same number; leave out one of them"
                )


FORM = "give names and bounds: {'spring.stiffness': (10.0, 500.0)}"
CONDITION = "write (measure, lowest, highest), with None where there is no end: (final('door.theta'), None, 0.01)"


@dataclass(frozen=True)
class Bounds:
    """Names of numbers, and how far each may go."""

    names: tuple[str, ...]
    low: np.ndarray
    high: np.ndarray

    @property
    def size(self) -> np.ndarray:
        """(k,) how far the bounds are apart."""
        return self.high - self.low


@dataclass(frozen=True)
class Condition:
    """A number of a motion that must keep within an interval."""

    name: str
    what: Any
    """A measure, a function of a solution, or the name of a number that varies."""
    low: float
    high: float
    """Infinite where there is no end."""


def bounds_of(m: Model, vary: Any) -> Bounds:
    """Check ``vary``. Raises ModelError for what are no bounds, or the wrong way round."""
    if not isinstance(vary, Mapping) or not vary:
        raise ModelError(f"{m.name}: optimise: vary is {shown(vary)}; {FORM}")
    rows = []
    for name, given in vary.items():
        if not isinstance(name, str) or not isinstance(given, Sequence | np.ndarray) or isinstance(given, str):
            raise ModelError(f"{m.name}: optimise: bounds of {shown(name)} are {shown(given)}; {FORM}")
        if len(given) != 2:
            raise ModelError(f"{m.name}: optimise: bounds of '{name}' are {shown(given)}; {FORM}")
        low, high = (finite_number(f"{m.name}: optimise: bound of '{name}'", end) for end in given)
        if not low < high:
            raise ModelError(
                f"{m.name}: optimise: '{name}' may be from {low:g} to {high:g}; the first must be smaller "
                "(leave out what keeps its value)"
            )
        rows.append((low, high))
    table = np.array(rows)
    return Bounds(tuple(vary), table[:, 0], table[:, 1])


def conditions_of(m: Model, given: Any) -> list[Condition]:
    """Check ``constraints``. Raises ModelError."""
    given = () if given is None else given
    if isinstance(given, Mapping):
        items = [(str(name), condition) for name, condition in given.items()]
    elif isinstance(given, list | tuple):
        items = [(_name(condition, k), condition) for k, condition in enumerate(given)]
    else:
        raise ModelError(f"{m.name}: optimise: constraints are {shown(given)}; give a list of conditions: {CONDITION}")
    out: list[Condition] = []
    for name, condition in items:
        if not isinstance(condition, tuple | list) or len(condition) != 3:
            raise ModelError(f"{m.name}: optimise: condition {name} is {shown(condition)}; {CONDITION}")
        what, low, high = condition
        ends = [
            sign * np.inf if end is None else finite_number(f"{m.name}: optimise: end of condition {name}", end)
            for end, sign in ((low, -1.0), (high, 1.0))
        ]
        if not np.isfinite(ends).any():
            raise ModelError(f"{m.name}: optimise: condition {name} has no end; {CONDITION}")
        if not ends[0] <= ends[1]:
            raise ModelError(
                f"{m.name}: optimise: condition {name} goes from {ends[0]:g} to {ends[1]:g}; the first must not be "
                "larger"
            )
        name = name if name not in {other.name for other in out} else f"{name} ({len(out) + 1})"
        out.append(Condition(name, what, *ends))
    return out


def _name(condition: Any, k: int) -> str:
    what = condition[0] if isinstance(condition, tuple | list) and condition else None
    if isinstance(what, str):
        return what
    quantity, called = getattr(what, "quantity", None), getattr(what, "__name__", "")
    return quantity or (called if called and called != "<lambda>" else f"{k + 1}")


def function_of_values(names: Sequence[str], what: Any) -> Callable[[np.ndarray], tuple[float, np.ndarray]] | None:
    """Return a function for value and gradient of what is one of the numbers by name; None for all else."""
    if not isinstance(what, str) or what not in names:
        return None
    k = names.index(what)
    return lambda x: (float(x[k]), np.eye(len(names))[k])
