"""Machines with other dimensions, evaluated: rows of deviations in, a number a machine out.

swept     one by one, each a copy with other lengths, places and numbers
simulated all in one compiled loop
computed  by a function of the user
(batched.py sweeps linkages all at once)
"""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any, Protocol

import numpy as np

from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.warning import quiet
from mbsd.dynamics.measures.kinds import Measure
from mbsd.model.body import at_end
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number, lengthened, number_in, place_in, put_together
from mbsd.tolerancing.dimensions.dimension import Column
from mbsd.tolerancing.dimensions.named import TOLERANCES
from mbsd.tolerancing.machines.results import NAME, FailingResult, NoNumber, OfSolution, called, number_of

LONGEST = 200
"""Letters of a reason."""


@dataclass
class Answers:
    """Numbers of n machines."""

    values: np.ndarray
    """(n,), NaN where a machine failed."""
    failures: Counter[str] = field(default_factory=Counter)
    """Number of failures by reason."""


class Machines(Protocol):
    """An evaluator of rows of deviations (n, columns) of a mechanism, or of a function."""

    at_once: int
    """Rows that it takes at most."""

    @property
    def way(self) -> str:
        """In words."""
        ...

    def __call__(self, x: np.ndarray) -> Answers:
        """The result of each row."""
        ...


def reason_of(error: MechanismError) -> str:
    """The type of an error and its first sentence."""
    said = " ".join(str(error).split()).partition(". ")[0].rstrip(".")
    return f"{type(error).__name__} ({said[:LONGEST]})" if said else type(error).__name__


class OneByOne:
    """Machines that are evaluated by a function of a row; those that it refuses have failed."""

    at_once = 64

    def __init__(self, way: str, evaluate: Callable[[np.ndarray], float]) -> None:
        self.way, self._evaluate = way, evaluate
        self._reasons: dict[type[MechanismError], str] = {}
        """Reasons of failures by type of error: each type is counted together, under its first message."""

    def evaluate(self, row: np.ndarray) -> float:
        """The result of a row. Raises what it raises."""
        return self._evaluate(row)

    def __call__(self, x: np.ndarray) -> Answers:
        """The result of each row."""
        out = Answers(np.full(len(x), np.nan))
        with quiet():
            for k, row in enumerate(x):
                try:
                    out.values[k] = self._evaluate(row)
                except FailingResult as error:
                    out.failures[error.reason] += 1
                except NoNumber:
                    raise
                except MechanismError as error:
                    out.failures[self._reasons.setdefault(type(error), reason_of(error))] += 1
        return out


def swept(m: Model, columns: Sequence[Column], result: Measure | Callable[[Any], Any], grid: np.ndarray) -> OneByOne:
    """Machines swept one by one over times ``grid`` (T,); they share the plan of ``m``."""
    from mbsd.kinematics.prepared import prepare
    from mbsd.kinematics.sweep import sweep

    of_solution = OfSolution(m, result)
    own = cache(lambda: prepare(m, float(grid[0]), float(grid[-1])))  # once, and if any is asked for

    def evaluate(row: np.ndarray) -> float:
        return of_solution(sweep(with_numbers(m, columns, row), None, 1, grid, beside=own()))

    return OneByOne("swept one by one", evaluate)


def with_numbers(m: Model, columns: Sequence[Column], row: np.ndarray) -> Any:
    """A copy of ``m`` whose numbers differ by a row of deviations."""
    out: Any = copy.deepcopy(m)
    places: list[tuple[Column, float]] = []
    changes: dict[str, dict[str, Any]] = {}
    parts: list[tuple[Number, float]] = []
    for column, deviation in zip(columns, row.tolist(), strict=True):
        value, own = column.nominal + deviation, changes.get(column.name, {})
        if column.kind == "length":
            changes[column.name] = {**lengthened(m, column.name, value), **own}
        elif column.kind == "argument":
            changes[column.name] = {**own, column.key: value}
        elif _number(m, column).marker is not None:
            places.append((column, deviation))
        else:
            parts.append((_number(m, column), value))
    put_together(out, [number for number, _ in parts], [value for _, value in parts], changes)
    for column, deviation in places:  # about where the ends of bars now are
        number = _number(out, column)
        number.assign(out, number.value + deviation)
    return out


def _number(m: Model, column: Column) -> Number:
    """Return the coordinate, or the number of a law or of whatever else, that a column strays by."""
    if column.kind == "part":
        return number_in(m, column.name, column.key, TOLERANCES)
    return place_in(m, column.name, column.key)


class Simulated:
    """Machines simulated in one compiled loop."""

    def __init__(
        self, m: Any, columns: Sequence[Column], result: Measure | Callable[[Any], Any], options: Mapping[str, Any]
    ) -> None:
        self._m, self._columns, self._options = m, columns, dict(options)
        self._result: Any = {NAME: result} if isinstance(result, Measure) else self._of_solution(result)
        self.at_once = 2000  # of more, progress would say nothing for long
        self._alone: Counter[str] = Counter()
        self._looped, self._note = False, ""
        for column in columns:
            if column.kind in ("bore", "reaction"):
                raise ModelError(
                    f"{m.name}: tolerances: the play of '{column.name}' cannot stray in a simulation. Give the motion "
                    "by drivers and sweep it, or vary the clearance of a clearance_joint"
                )
            if column.kind == "place" and column.name in m.traces and column.name in m.joints:
                raise ModelError(
                    f"{m.name}: tolerances: '{column.name}' is a joint and a traced point; rename one of them"
                )
        self._ends = [self._end(column) for column in columns]

    @property
    def way(self) -> str:
        """How all so far were simulated, in words."""
        alone = [f"{number} one by one ({why})" for why, number in self._alone.most_common()]
        return ", ".join(
            ["simulated in one compiled loop" + self._note, *alone] if self._looped else ["simulated", *alone]
        )

    def _end(self, column: Column) -> int | None:
        """The column that is the length of a bar, along which a place at its end moves."""
        marker = None
        if column.kind in ("place", "part") and column.key.rpartition(".")[2] == "x":
            marker = number_in(self._m, column.name, column.key, TOLERANCES).marker
        if marker is None or not at_end(marker, marker.body.length):
            return None
        lengths = [(other.kind, other.name) for other in self._columns]
        bar = "length", marker.body.name
        return lengths.index(bar) if bar in lengths else None

    def _of_solution(self, result: Callable[[Any], Any]) -> Callable[[Any], dict[str, float]]:
        of_solution = OfSolution(self._m, result)
        return lambda sol: {NAME: of_solution(sol)}

    def __call__(self, x: np.ndarray) -> Answers:
        """The result of each row."""
        vary: dict[str, dict[str, np.ndarray]] = {}
        for k, (column, end) in enumerate(zip(self._columns, self._ends, strict=True)):
            nominal = column.nominal if end is None else self._columns[end].nominal + x[:, end]
            vary.setdefault(column.name, {})[column.key] = nominal + x[:, k]
        many = self._m.simulate_many(vary=vary, measure=self._result, **self._options)
        self._alone += Counter(why for why in many.alone if why is not None)
        self._looped |= None in many.alone
        self._note = f" ({many.note})" if many.note else self._note
        failures: Counter[str] = Counter(" ".join(reason.split())[:120] for reason in many.reason if reason)
        wrong = next((reason for reason in failures if reason.startswith(f"{NoNumber.__name__}: ")), None)
        if wrong:
            raise NoNumber(wrong.partition(": ")[2])
        return Answers(many[NAME].reshape(len(x)), failures)


def computed(
    name: str, function: Callable[..., Any], columns: Sequence[Column], measure: Callable[[Any], Any]
) -> OneByOne:
    """Numbers of ``function`` of its arguments by name, of which ``measure`` makes the result."""

    def evaluate(row: np.ndarray) -> float:
        named = {column.name: column.nominal + d for column, d in zip(columns, row.tolist(), strict=True)}
        return number_of(name, measure(called(name, function, **named)))

    machines = OneByOne("computed one by one", evaluate)
    machines.at_once = 1024
    return machines
