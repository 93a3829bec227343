"""The simulations that are asked for: values of numbers, of starts and of velocities, row by row, as mechanisms.

vary={"closer": {"stiffness": [...], "damping": [...]}, "hinge": {"x": [...]}}       see numbers/rows.py
start={"door": [...]}       as m.start_near: degrees (n,), or (x, y, degrees) (n, 3)
moving={"door": [...]}      as m.start_moving: rad/s (n,), or (vx, vy, omega) (n, 3)
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from mbsd.base.arguments import number_array
from mbsd.base.errors import ModelError
from mbsd.model.body import Body
from mbsd.model.mechanism import Model, StartVelocity, start_given
from mbsd.numbers.names import Number, put_together
from mbsd.numbers.rows import VARY, Varied, named, refuse_law, refuse_wide, varied
from mbsd.numbers.saved import SavedModel

MOST = 100_000_000
"""Simulations of one call."""


@dataclass
class Designs:
    """Numbers that vary, as arrays over ``count`` rows."""

    m: Model
    count: int
    columns: list[Varied]
    exact: bool = False
    """True if each has the digits of a simulation by itself, whichever others are beside it."""

    @cached_property
    def changes(self) -> dict[str, dict[str, np.ndarray]]:
        """By name and argument of ``change`` (count,) or (count, k)."""
        out: dict[str, dict[str, np.ndarray]] = {}
        for each in self.columns:
            if each.given == VARY and each.number is None:
                out.setdefault(each.whole, {})[each.key] = each.values
        return out

    @cached_property
    def numbers(self) -> list[tuple[Varied, Number]]:
        """Return numbers that ``change`` does not take as a whole: places, numbers of laws."""
        return [(each, each.number) for each in self.columns if each.number is not None]

    @cached_property
    def starts(self) -> dict[str, np.ndarray]:
        """(count, 1) degrees or (count, 3) by body."""
        return {each.whole: each.values for each in self.columns if each.given == "start"}

    @cached_property
    def velocities(self) -> dict[str, np.ndarray]:
        """(count, 1) rad/s or (count, 3) by body."""
        return {each.whole: each.values for each in self.columns if each.given == "moving"}

    def copied(self) -> Any:
        """A mechanism of its own to be changed."""
        return copy.deepcopy(self.m)

    def row_by_row(self) -> Callable[[int], Any]:
        """Return what gives the mechanism of a row, until the next is asked for."""
        return RowByRow(self)

    def extremes(self) -> set[int]:
        """Rows in which a number is the least or the largest of its column: one row may differ from all others."""
        wide = [each.values.reshape(self.count, -1) for each in self.columns]
        return {int(row) for column in wide for rows in (column.argmin(0), column.argmax(0)) for row in rows}

    def put_numbers(self, work: Any, row: int) -> None:
        """Give ``work``, which is as it was copied, all numbers of a row but its start. Raises ModelError."""
        changes = {
            name: {key: _plain(column[row]) for key, column in values.items()} for name, values in self.changes.items()
        }
        numbers, values = [number for _, number in self.numbers], [float(each.values[row]) for each, _ in self.numbers]
        put_together(work, numbers, values, changes)

    def put_start(self, work: Any, row: int) -> None:
        """Only the start of it, as start_near and start_moving set it. Raises ModelError as these do."""
        for name, values in self.starts.items():
            *place, degrees = values[row].tolist()
            work.starts[name] = start_given(work, name, degrees, tuple(place) or None)
        for name, values in self.velocities.items():
            *place, omega = values[row].tolist()
            work.velocities[name] = StartVelocity(omega, tuple(place) or None)


class RowByRow:
    """A copy of the mechanism of ``designs`` that becomes that of one row after another."""

    def __init__(self, designs: Designs) -> None:
        self._designs, self.m = designs, designs.copied()
        self._saved = SavedModel(self.m)

    def __call__(self, row: int) -> Any:
        """Return the mechanism of a row, until the next is asked for. Raises ModelError for numbers that it refuses."""
        self._saved.restore()  # what stands at the end of a bar depends on its length
        self._designs.put_numbers(self.m, row)
        self._designs.put_start(self.m, row)
        return self.m


class Built(Designs):
    """Mechanisms that were built one by one, and may differ in anything."""

    def __init__(self, mechanisms: Sequence[Model], why: str) -> None:
        super().__init__(mechanisms[0], len(mechanisms), [], exact=True)
        self.mechanisms = mechanisms
        self.why = why
        """Why their numbers are not put into one of them."""

    def row_by_row(self) -> Callable[[int], Any]:
        """Return what gives the mechanisms as they were built."""
        return self.mechanisms.__getitem__


def _plain(value: Any) -> Any:
    """A number, or several of them, as the methods take them."""
    out = np.asarray(value).tolist()
    return out[0] if isinstance(out, list) and len(out) == 1 else out


def designs_of(m: Model, vary: Any, start: Any, moving: Any) -> Designs:
    """Check what is asked for. Raises ModelError for names that do not exist and lists that do not fit."""
    _refuse_too_many(m, vary, start, moving)
    columns = sorted(varied(m, vary), key=lambda each: each.number is not None)
    for what, given in (("start", start), ("moving", moving)):
        columns += [Varied(what, name, what, _wide(m, what, name, own)) for name, own in named(m, what, given).items()]
    if not columns:
        raise ModelError(f"{m.name}: simulate_many: nothing varies; give vary=, start= or moving=")
    count = max(len(each.values) for each in columns)
    for each in columns:
        what = f"{m.name}: simulate_many: {each.key} of '{each.whole}' has"
        if len(each.values) not in (1, count):
            raise ModelError(
                f"{what} {len(each.values)} values and another list has {count}; they must be equally long, or a "
                "single number"
            )
        if not len(each.values):
            raise ModelError(f"{what} no values; give one or more")
    whole = [np.broadcast_to(each.values, (count, *each.values.shape[1:])) for each in columns]
    out = Designs(m, count, [each._replace(values=own) for each, own in zip(columns, whole, strict=True)])
    _refuse_unknown(out)
    return out


def _refuse_too_many(m: Model, *given: Any) -> None:
    """Raise ModelError for longer lists than there may be, before any is looked through."""
    for part in given:
        for values in part.values() if isinstance(part, Mapping) else ():
            for column in values.values() if isinstance(values, Mapping) else (values,):
                count = len(column) if isinstance(column, list | tuple) else (np.shape(column) or (1,))[0]
                if count > MOST:
                    raise ModelError(
                        f"{m.name}: simulate_many: {count} simulations; take {MOST} at most, in several calls"
                    )


def _refuse_unknown(designs: Designs) -> None:
    """Raise ModelError for names and arguments that the mechanism does not have, as its own methods do."""
    work = designs.copied()
    for name, values in designs.changes.items():
        try:
            work.change(name, **{key: _plain(column[0]) for key, column in values.items()})
        except ModelError as error:
            if "there is no" in str(error):
                raise ModelError(str(error).replace(f"{work.name}: ", f"{work.name}: vary: ", 1)) from None
            refuse_law(designs.m, name, list(values))
        refuse_wide(work, name, values)
    starts = {(each.given, each.whole) for each in designs.columns if each.given != VARY}
    for each, number in designs.numbers:
        if (each.of_start, each.whole) in starts:
            raise ModelError(
                f"{work.name}: vary: '{number.name}' is also given by {each.of_start}=; leave out one of them"
            )
    for each in designs.columns:
        if each.given != VARY or each.of_start:
            what = each.given if each.given != VARY else f"vary: {each.of_start}"
            _refuse_held(work, what, work.known_body(each.whole))


def _refuse_held(m: Model, what: str, body: Body) -> None:
    """Raise ModelError for the ground, and for a body whose angle a driver imposes: each row would be the same."""
    if body.name == "ground":
        raise ModelError(f"{m.name}: {what}: ground does not move; give other bodies")
    for driver in m.drivers.values():
        if "angle" in driver.kind.constraints and {driver.i.body.name, driver.j.body.name} == {"ground", body.name}:
            raise ModelError(
                f"{m.name}: {what}: driver '{driver.name}' says where '{body.name}' is and how fast; start others, or "
                "take a motor instead of the driver"
            )


def _wide(m: Model, what: str, name: str, values: Any) -> np.ndarray:
    column = np.atleast_1d(number_array(f"{m.name}: {what}: '{name}'", values))
    column = column[:, None] if column.ndim == 1 else column
    if column.ndim != 2 or column.shape[1] not in (1, 3):
        raise ModelError(f"{m.name}: {what}: '{name}' has shape {np.shape(values)}; give (n,) or (n, 3)")
    return column
