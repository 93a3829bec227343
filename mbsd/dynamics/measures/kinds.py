"""Measures of each of many simulations: a few numbers of a quantity along its outputs, by functions of their own.

    final("door.theta")                      at the last output
    largest("A.fx"), smallest("A.fx")        over all outputs, and when: two columns
    integral("motor.power")                  over time, by the trapezoidal rule
    first("door.theta", below=0.02)          when it first is there, by a straight line between two outputs
    samples("P.x", [0.5, 1.0])               at chosen outputs

Quantities are named as the columns of a solution are, without their units (quantities.py).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.base.arguments import finite_number, number_array, text
from mbsd.base.errors import ModelError

TIME = "_time"
"""Ending of the column that says when."""
NEAR = 1e-9
"""Part of the duration within which a time is that of an output."""


@dataclass(frozen=True)
class Measure:
    """Numbers of one quantity."""

    quantity: str

    @property
    def quantities(self) -> tuple[str, ...]:
        """All that it reads."""
        return (self.quantity,)

    def columns(self, name: str) -> tuple[str, ...]:
        """Names of what it gives."""
        return (name,)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of what it gives for one simulation."""
        return ()

    @property
    def ends(self) -> bool:
        """True if it may be known before the last output."""
        return False

    @property
    def reads_few(self) -> bool:
        """True if it reads the outputs that are ``needed`` alone, which are few, whatever the others are."""
        return False

    @property
    def threshold(self) -> tuple[float, bool] | None:
        """Return the value that its quantity is to pass and True if from above; None where more decides."""
        return None

    def known(self, t: np.ndarray, along: Mapping[str, np.ndarray]) -> np.ndarray:
        """(n,) whether the outputs so far tell it, of which these are the last; see batch/loop.py."""
        return np.zeros(len(along[self.quantity]), bool)

    def needed(self, t: np.ndarray) -> np.ndarray:
        """Rows of the output times (T,) whose values it reads."""
        return np.arange(len(t))

    def check(self, what: str, t: np.ndarray) -> None:
        """Raise ModelError where it does not suit output times (T,)."""

    def of(self, name: str, t: np.ndarray, along: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """By column, (n,) or (n, k) from values (n, T) of each quantity at times (T,), or (n, T)."""
        raise NotImplementedError


@dataclass(frozen=True)
class _Final(Measure):
    @property
    def reads_few(self) -> bool:
        return True

    def needed(self, t: np.ndarray) -> np.ndarray:
        return np.array([len(t) - 1])

    def of(self, name: str, t: np.ndarray, along: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        return {name: along[self.quantity][:, -1].copy()}


@dataclass(frozen=True)
class _Extreme(Measure):
    sign: float = 1.0

    def columns(self, name: str) -> tuple[str, ...]:
        return name, name + TIME

    def of(self, name: str, t: np.ndarray, along: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        values = along[self.quantity]
        at, rows = np.argmax(self.sign * values, axis=1), np.arange(len(values))
        return {name: values[rows, at], name + TIME: np.broadcast_to(t, values.shape)[rows, at]}


@dataclass(frozen=True)
class _Integral(Measure):
    def of(self, name: str, t: np.ndarray, along: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        values = along[self.quantity]
        return {name: (0.5 * (values[:, 1:] + values[:, :-1]) * np.diff(t)).sum(axis=1)}


@dataclass(frozen=True)
class _First(Measure):
    level: float = 0.0
    below: bool = True
    give: str | None = None

    @property
    def quantities(self) -> tuple[str, ...]:
        return (self.quantity,) if self.give is None else (self.quantity, self.give)

    @property
    def ends(self) -> bool:
        return True

    @property
    def threshold(self) -> tuple[float, bool] | None:
        return self.level, self.below

    def known(self, t: np.ndarray, along: Mapping[str, np.ndarray]) -> np.ndarray:
        return self._there(along).any(axis=1)

    def _there(self, along: Mapping[str, np.ndarray]) -> np.ndarray:
        values = along[self.quantity]
        return values < self.level if self.below else values > self.level

    def of(self, name: str, t: np.ndarray, along: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        values, there = along[self.quantity], self._there(along)
        k, rows = np.argmax(there, axis=1), np.arange(len(values))
        before = np.maximum(k - 1, 0)
        here, last = values[rows, k] - self.level, values[rows, before] - self.level
        rise = np.where(k > 0, here - last, 1.0)
        share = np.where(k > 0, -last / np.where(rise == 0.0, 1.0, rise), 0.0)
        given = np.broadcast_to(t, values.shape) if self.give is None else along[self.give]
        out = given[rows, before] + share * (given[rows, k] - given[rows, before])
        return {name: np.where(there[rows, k], out, np.nan)}


@dataclass(frozen=True)
class _Samples(Measure):
    times: tuple[float, ...] = ()

    @property
    def shape(self) -> tuple[int, ...]:
        return (len(self.times),)

    @property
    def ends(self) -> bool:
        return True

    @property
    def reads_few(self) -> bool:
        return True

    def known(self, t: np.ndarray, along: Mapping[str, np.ndarray]) -> np.ndarray:
        return np.full(len(along[self.quantity]), t[-1] >= max(self.times))

    def check(self, what: str, t: np.ndarray) -> None:
        for time in self.times:
            if np.abs(t - time).min() > NEAR * np.ptp(t):
                raise ModelError(
                    f"{what}: {time:g} s is no output; the nearest is at {t[np.abs(t - time).argmin()]:g} s. "
                    "Give such times, or other steps or times of the simulation"
                )

    def needed(self, t: np.ndarray) -> np.ndarray:
        return np.abs(t[..., None] - np.array(self.times)).argmin(axis=-2)

    def of(self, name: str, t: np.ndarray, along: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        values = along[self.quantity]
        at = np.broadcast_to(self.needed(t), (len(values), len(self.times)))
        return {name: np.take_along_axis(values, at, axis=1)}


def final(quantity: str) -> Measure:
    """The value of ``quantity`` at the last output."""
    return _Final(text("final: quantity", quantity))


def largest(quantity: str) -> Measure:
    """The largest value of ``quantity`` among the outputs, and in a second column, ``..._time``, when (s)."""
    return _Extreme(text("largest: quantity", quantity))


def smallest(quantity: str) -> Measure:
    """The smallest value of ``quantity`` among the outputs, and in a second column, ``..._time``, when (s)."""
    return _Extreme(text("smallest: quantity", quantity), -1.0)


def integral(quantity: str) -> Measure:
    """The integral of ``quantity`` over time, by the trapezoidal rule over the outputs."""
    return _Integral(text("integral: quantity", quantity))


def first(quantity: str, below: float | None = None, above: float | None = None, give: str | None = None) -> Measure:
    """When (s) ``quantity`` first is ``below`` or ``above`` a number at an output; NaN where it never is.

    The time is where the straight line from the output before passes that number. ``give`` names another quantity,
    whose value at that time is given in its place. Raises ModelError unless one of ``below`` and ``above`` is given.
    """
    if (below is None) == (above is None):
        raise ModelError(f"first('{quantity}'): give either below= or above=, a number")
    level = finite_number(f"first('{quantity}'): {'below' if above is None else 'above'}",
                          below if above is None else above)  # fmt: skip
    return _First(
        text("first: quantity", quantity), level, above is None, None if give is None else text("first: give", give)
    )


def samples(quantity: str, times: Sequence[float]) -> Measure:
    """Values (n, k) of ``quantity`` at ``times`` (k,) (s), each of them that of an output."""
    wanted = number_array(f"samples('{quantity}'): times", times)
    if wanted.ndim != 1 or not len(wanted):
        raise ModelError(f"samples('{quantity}'): times are a list of one or more numbers (s)")
    return _Samples(text("samples: quantity", quantity), tuple(wanted.tolist()))
