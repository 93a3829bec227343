"""The simulations that are asked for: values of arguments, starts and velocities, row by row, as mechanisms.

vary={"twist": {"stiffness": [...]}, "top": {"inertia": [...]}}      arguments of m.change, (n,) or (n, k)
start={"hinge": [...]}     as m.start_near: degrees, m (n,)
moving={"hinge": [...], "top": [...]}     as m.start_moving: rad/s, m/s (n,), of a body (n, 3) or (n, 6)
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from mbsd.base.arguments import number_array
from mbsd.base.errors import ModelError


class Column(NamedTuple):
    """Values of one thing that varies."""

    given: str
    """vary, start or moving."""
    name: str
    key: str
    """The argument of ``change``; empty for starts."""
    values: np.ndarray
    """(n,) or (n, k); as many rows as there are simulations."""

    def __str__(self) -> str:
        return f"'{self.name}' {self.key}" if self.key else f"{self.given} of '{self.name}'"


@dataclass
class Designs:
    """Numbers that vary over ``count`` rows."""

    m: Any
    count: int
    columns: list[Column]

    @property
    def numbers(self) -> np.ndarray:
        """(n, k) all numbers of all columns behind one another."""
        parts = [column.values.reshape(self.count, -1) for column in self.columns]
        return np.concatenate([np.zeros((self.count, 0)), *parts], axis=1)

    def owner(self, number: int) -> Column:
        """Return the column to which a number of a row belongs."""
        return [column for column in self.columns for _ in range(column.values[0].size)][number]

    def copied(self) -> Any:
        """Return a mechanism of its own to be changed."""
        return copy.deepcopy(self.m)

    def set_numbers(self, own: Any, numbers: np.ndarray) -> Any:
        """Return ``own``, a copy of the mechanism, with the numbers (k,) of a row. Raises ModelError."""
        changes: dict[str, dict[str, Any]] = {}
        begin = 0
        for column in self.columns:
            shape = column.values.shape[1:]
            value = numbers[begin : begin + column.values[0].size].reshape(shape).tolist()
            begin += column.values[0].size
            if column.given == "vary":
                changes.setdefault(column.name, {})[column.key] = value
            else:
                (own.start_near if column.given == "start" else own.start_moving)({column.name: value})
        for name, values in changes.items():
            own.change(name, **values)
        return own


def designs_of(m: Any, vary: Any, start: Any, moving: Any) -> Designs:
    """Check what is asked for. Raises ModelError for lists that do not fit, and where the first row is refused."""
    columns = []
    for name, changes in (vary or {}).items():
        if not isinstance(changes, Mapping):
            raise ModelError(f"{m.name}: vary: '{name}' needs names of arguments and values, {{'mass': [1, 2]}}")
        columns += [Column("vary", name, key, values) for key, values in changes.items()]
    for given, table in (("start", start), ("moving", moving)):
        columns += [Column(given, name, "", values) for name, values in (table or {}).items()]
    for k, column in enumerate(columns):
        values = number_array(f"{m.name}: {column}", column.values)
        whole = values.ndim == 0 or (values.ndim == 1 and column.given == "moving" and column.name in m.bodies)
        columns[k] = column._replace(values=values[None] if whole else values)
    counts = {str(column): len(column.values) for column in columns if len(column.values) != 1}
    if len(set(counts.values())) > 1 or 0 in counts.values():
        said = ", ".join(f"{what} {count}" for what, count in counts.items())
        raise ModelError(f"{m.name}: numbers of values differ: {said}; give as many of each, or one for all")
    count = next(iter(counts.values()), 1)
    columns = [c._replace(values=np.broadcast_to(c.values, (count, *c.values.shape[1:]))) for c in columns]
    designs = Designs(m, count, columns)
    designs.set_numbers(designs.copied(), designs.numbers[0])
    return designs
