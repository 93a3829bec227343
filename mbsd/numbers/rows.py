"""Numbers that vary, by name: arguments of ``change``, and places, laws' numbers and others.

vary={"closer": {"stiffness": [...], "damping": [...]}, "door": {"mass": [...]}}     as m.change takes them
vary={"hinge": {"x": [...]}, "motor": {"rate": [...]}, "door": {"hinge.y": [...]}}   as numbers/names.py names them
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from mbsd.base.arguments import number_array
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.change import takes, values_of
from mbsd.model.mechanism import Model
from mbsd.numbers.names import START, Number, number_in, numbers_within, twin_of, with_values

VARY = "vary"


class Varied(NamedTuple):
    """One argument of ``change``, another number, or a start or velocity, and its values."""

    given: str
    """VARY, "start" or "moving"."""
    whole: str
    key: str
    values: np.ndarray
    """(n,), or (n, k) of what takes k numbers"""
    number: Number | None = None
    """A number that ``change`` does not take as a whole."""

    @property
    def of_start(self) -> str | None:
        """ "start" or "moving", of a number that start_near or start_moving gave."""
        first, _, inner = self.key.partition(".")
        return first if inner in START.get(first, ()) else None  # "start" alone is a number of laws


def varied(m: Model, vary: Any) -> list[Varied]:
    """Arguments of ``change``, and other numbers. Raises ModelError for names that there are not."""
    out: list[Varied] = []
    for name, values in named(m, VARY, vary).items():
        if not isinstance(values, Mapping) or not all(isinstance(key, str) for key in values):
            whole, _, key = name.partition(".")
            example = f"{{'{whole}': {{'{key}': [...]}}}}" if key else "{'spring': {'stiffness': [...]}}"
            raise ModelError(
                f"{m.name}: vary: '{name}' is {shown(values)}; give its numbers and their values: {example}"
            )
        for key, given in values.items():
            column = _column(f"{m.name}: vary: {key} of '{name}'", given)
            number = None if takes(m, name, key) else number_in(m, name, key, VARY)
            if number is not None and column.ndim > 1:
                raise _too_wide(m, name, key, column)
            out.append(Varied(VARY, name, key, column, number))
    _refuse_twice(m, out)
    return out


def _refuse_twice(m: Model, every: Sequence[Varied]) -> None:
    """Raise ModelError where a number varies under two names."""
    changes = {(each.whole, each.key) for each in every if each.number is None}
    numbers = [(each, each.number) for each in every if each.number is not None]
    for k, (each, number) in enumerate(numbers):
        at = number.within
        if at is not None and (at.whole, at.key) in changes:
            raise ModelError(
                f"{m.name}: vary: '{at.whole}': '{each.key}' is a part of '{at.key}'; leave out one of them"
            )
        others = each.values[each.values != number.value]
        if not len(others) or k + 1 == len(numbers):
            continue
        new = float(others[0])
        try:
            other = with_values(m, [number], [new])
        except ModelError:
            continue  # a row may have that
        twin = twin_of(number, other, new, [own for _, own in numbers[k + 1 :]])
        if twin is not None:
            raise ModelError(f"{m.name}: vary: '{number.name}' and '{twin.name}' are the same number; leave out one")


def refuse_wide(m: Model, name: str, values: Mapping[str, np.ndarray]) -> None:
    """Raise ModelError for several numbers a row where the mechanism has a single one."""
    nominal = values_of(m, name) or {}
    for key, column in values.items():
        if column.ndim > 1 and column.shape[1] > 1 and isinstance(nominal.get(key), int | float):
            raise _too_wide(m, name, key, column)


def refuse_law(m: Model, name: str, keys: Sequence[str]) -> None:
    """Raise ModelError where what ``change`` refused numbers for is a law."""
    nominal = values_of(m, name) or {}
    for key in keys:
        within = numbers_within(nominal.get(key))
        if within:
            raise ModelError(
                f"{m.name}: vary: {key} of '{name}' is a law and no number; its numbers vary by their names: "
                f"{{'{name}': {{'{within[0]}': [...]}}}}"
            )


def _too_wide(m: Model, name: str, key: str, column: np.ndarray) -> ModelError:
    return ModelError(
        f"{m.name}: vary: {key} of '{name}' is a single number, and its values have shape {column.shape}; "
        f"give ({len(column)},), a number a simulation"
    )


def named(m: Model, what: str, given: Any) -> Mapping[str, Any]:
    """Names and their values. Raises ModelError for anything else."""
    if given is None:
        return {}
    if not isinstance(given, Mapping) or not all(isinstance(name, str) for name in given):
        raise ModelError(f"{m.name}: {what} is {shown(given)}; give names and their values: {{name: [...]}}")
    return given


def _column(what: str, values: Any) -> np.ndarray:
    """(n,) or (n, k)."""
    column = np.atleast_1d(number_array(what, values))
    if column.ndim > 2:
        raise ModelError(f"{what} has shape {column.shape}; give (n,), or (n, k) of what takes k numbers")
    return column
