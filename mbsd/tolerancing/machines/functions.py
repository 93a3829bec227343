"""A function of numbers in place of a mechanism: it gives the result, or what that is taken from."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.dynamics.measures.kinds import Measure
from mbsd.model.mechanism import Model
from mbsd.tolerancing.dimensions.named import numbers_of
from mbsd.tolerancing.machines.one_by_one import computed
from mbsd.tolerancing.machines.results import OfSolution, called, number_of, result_given
from mbsd.tolerancing.machines.tasks import Task, alone


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
            f"{owner}: tolerances: it gives a mechanism, and result= is missing; give a measure of mbsd.measures, such "
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
