"""The motion of a mechanism with other numbers, its measures, and their derivatives by these numbers."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from mbsd.base.arguments import switch
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.derivatives.driven.sweeps import SweepTangents
from mbsd.derivatives.requests import refuse_unfit
from mbsd.derivatives.sensitivities import Tangents, moves_freely, simulation_tangents, values_and_slopes
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.simulate import output_times, refuse_bad_steps
from mbsd.kinematics.sweep import sweep, sweep_times
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number, number_named, twin_of, with_values
from mbsd.results.solution import Solution
from mbsd.synthesis.built import built, refuse_build
from mbsd.synthesis.wishes import Bounds, Condition, function_of_values

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
                    f"{self.m.name}: optimise: {label} gives {value.size} numbers; it must give one: take a measure, "
                    "such as largest(...), of it"
                )
        out = []
        for label, known in own.items():
            if known is not None:
                out.append(known(x))
                continue
            slope = slopes[label].reshape(-1)
            if not (np.isfinite(slope).all() and np.isfinite(values[label]).all()):
                raise ModelError(f"{self.m.name}: optimise: {label} is no number in this motion, or has no derivative")
            out.append((float(values[label].reshape(())), slope))
        (value, slope), *rest = out
        return Tried(value, slope, [v for v, _ in rest], [s for _, s in rest], tangents.solve, model)

    def model(self, x: np.ndarray) -> Any:
        """The mechanism with numbers x. Raises what the author's function raises."""
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

        def beside(k: int, value: float) -> Model:
            return self.model(np.where(np.arange(len(x)) == k, value, x))

        def put(m: Model, value: float) -> None:
            raise AssertionError("it is built")

        return [
            Number(name, float(x[k]), put, partial(beside, k), reach=float(self.bounds.size[k]))
            for k, name in enumerate(self.bounds.names)
        ]

    def _defaults(self, build: Callable[..., Any]) -> np.ndarray:
        """(k,) defaults of the author's function, the middle of the bounds where it has none. Raises ModelError."""
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
    """Raise ModelError for two names of one number, and for bounds at whose ends the mechanism refuses the number."""
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
