"""Mechanisms that differ in numbers alone, and these numbers as ``simulate_many`` takes them.

As bytes (pickle) a mechanism has each of its numbers as eight bytes behind an opcode. Mechanisms that a function built
in one way have the same bytes but for these, so one comparison finds what differs, in some 25 us a mechanism. What such
a number is, a change of the first mechanism tells: it moves the same bytes. Some mechanisms are changed into as a whole
and compared, number by number.

Known are numbers of forces, masses and moments of inertia. Where others vary, each mechanism is prepared as it is.
"""

from __future__ import annotations

import copy
import pickle
import pickletools
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from mbsd.base.errors import MechanismError
from mbsd.dynamics.batch.designs import designs_of
from mbsd.mechanism import Mechanism

PROTOCOL = 5
SHARED = {"PROTO", "FRAME", "BINGET", "LONG_BINGET"}
"""Opcodes of pickle that say how much comes, and what comes again."""
COMPARED = 3
"""Mechanisms that are changed into and compared."""
OTHER = "build makes mechanisms that differ in more than numbers"
ELSEWHERE = "numbers differ that are neither of a force nor a mass"


class MoreThanNumbers(Exception):
    """Why mechanisms do not differ in known numbers alone."""


Changes = dict[str, dict[str, np.ndarray]]
"""Names to arguments of ``change`` and their values (n,)."""


def differences(mechanisms: Sequence[Mechanism]) -> Changes:
    """Return how the others differ from the first. Raises MoreThanNumbers unless that is in numbers alone."""
    first = mechanisms[0]
    numbers = _Numbers(first)
    values = np.array([numbers.values(m) for m in mechanisms])
    left = set(np.flatnonzero((values != values[0]).any(axis=0)).tolist())
    if not left:
        raise MoreThanNumbers("build makes the same mechanism at all points")
    changes: Changes = {}
    work = copy.deepcopy(first)
    for number in _known(first):
        own, moved = _moved(number, work, numbers, values, left)
        if own is not None:
            left -= moved
            changes.setdefault(number.name, {})[number.key] = values[:, own]
    if left:
        raise MoreThanNumbers(ELSEWHERE)
    _compare(first, changes, numbers, values)
    return changes


class _Numbers:
    """Where mechanisms like one have their numbers as bytes."""

    def __init__(self, m: Mechanism) -> None:
        content = _bytes(m)
        at = [
            place + 1 for code, _, place in pickletools.genops(content) if code.name == "BINFLOAT" and place is not None
        ]
        self.at = (np.array(at, np.int64)[:, None] + np.arange(8)).reshape(-1)
        self.rest = np.ones(len(content), bool)
        self.rest[self.at] = False
        self.fixed = np.frombuffer(content, np.uint8)[self.rest]
        self.parts = _parts(content)[1]

    def values(self, m: Mechanism) -> np.ndarray:
        """Return (N,) numbers of another. Raises MoreThanNumbers where it has other bytes besides."""
        content = np.frombuffer(_bytes(m), np.uint8)
        if len(content) != len(self.rest) or not np.array_equal(content[self.rest], self.fixed):
            raise MoreThanNumbers(OTHER)
        return content[self.at].reshape(-1, 8).view(">f8")[:, 0].astype(float)

    def values_changed(self, m: Mechanism) -> np.ndarray:
        """Return (N,) values of a changed mechanism, in which other things may be shared.

        Raises MoreThanNumbers.
        """
        values, rest = _parts(_bytes(m))
        if len(values) != len(self.at) // 8 or rest != self.parts:
            raise MoreThanNumbers(ELSEWHERE)
        return values


def _parts(content: bytes) -> tuple[np.ndarray, list[Any]]:
    """Return numbers, and all else but where what comes again stands."""
    values, rest = [], []
    for code, value, _ in pickletools.genops(content):
        if code.name == "BINFLOAT":
            values.append(value)
        elif value is not None and code.name not in SHARED:
            rest.append(value)
    return np.array(values), rest


def _bytes(m: Mechanism) -> bytes:
    try:
        return pickle.dumps(m, PROTOCOL)
    except Exception as error:  # functions of the user that have no name
        raise MoreThanNumbers("mechanisms have functions of Python") from error


class _Number(NamedTuple):
    """A number of a mechanism that may vary, as ``change`` names it."""

    name: str
    key: str
    value: float


def _known(m: Mechanism) -> Iterator[_Number]:
    for force in m.forces.values():
        for key, value in force.params.items():
            if isinstance(value, float):
                yield _Number(force.name, key, value)
    for body in m.bodies.values():
        if body.name != "ground":
            yield _Number(body.name, "mass", body.mass)
            if "inertia" not in body.derived:
                yield _Number(body.name, "inertia", body.inertia)


def _moved(
    number: _Number, work: Mechanism, numbers: _Numbers, values: np.ndarray, left: set[int]
) -> tuple[int | None, set[int]]:
    """Return the place of a number that differs, and all that move with it.

    None if it is none of ``left``.
    """
    for place in sorted(left):
        if values[0, place] != number.value:
            continue
        other = float(values[np.flatnonzero(values[:, place] != number.value)[0], place])
        try:
            work.change(number.name, **{number.key: other})
            changed = numbers.values_changed(work)
            work.change(number.name, **{number.key: number.value})
            back = numbers.values_changed(work)
        except MechanismError:
            raise MoreThanNumbers(ELSEWHERE) from None
        if not np.array_equal(back, values[0]):
            raise MoreThanNumbers(ELSEWHERE)
        moved = set(np.flatnonzero(changed != values[0]).tolist())
        if place in moved and changed[place] == other:
            return place, moved
    return None, set()


def _compare(first: Mechanism, changes: Changes, numbers: _Numbers, values: np.ndarray) -> None:
    """Raise MoreThanNumbers unless the first mechanism changes into others by these."""
    designs = designs_of(first, changes, None, None)
    for row in sorted({*np.linspace(0, len(values) - 1, COMPARED, dtype=int).tolist()}):
        work = designs.copied()
        try:
            designs.put_numbers(work, row)
        except MechanismError:
            continue  # that is its reason
        if not np.array_equal(numbers.values_changed(work), values[row]):
            raise MoreThanNumbers(ELSEWHERE)
