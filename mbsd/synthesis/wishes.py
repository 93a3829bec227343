"""Requests to an optimisation, checked before anything runs: numbers with bounds, an objective, conditions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.mechanism import Model

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
    """Value and gradient by the numbers x of what is one of them by name; None of all else."""
    if not isinstance(what, str) or what not in names:
        return None
    k = names.index(what)
    return lambda x: (float(x[k]), np.eye(len(names))[k])
