"""Output times of a motion as given by the user, with checks of their order and of the results' size."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.arguments import finite_number, number_array, whole_number
from mbsd.base.errors import ModelError
from mbsd.base.names import shown

if TYPE_CHECKING:
    from mbsd.model.mechanism import Model

SHORTEST, LONGEST = 1e-20, 1e18
"""Durations (s); the universe is 4e17 s old."""
COPIES = 3
"""Estimate of how often the results are in memory at once."""


def rising_times(m: Model, times: Sequence[float] | np.ndarray, least: int) -> np.ndarray:
    """Return ``times`` (T,) as given, at least ``least``.

    Raises ModelError unless it is a list of rising finite numbers.
    """
    check_count(m, _length(times))  # before a copy is made
    grid = number_array(f"{m.name}: times", times)
    if grid.ndim != 1 or len(grid) < least:
        some = "two or more" if least == 2 else "one or more"
        raise ModelError(f"{m.name}: times are {shown(times)}; they must be {some} rising finite numbers")
    rises = np.diff(grid) > 0
    if not rises.all():
        k = int(np.argmin(rises))
        raise ModelError(
            f"{m.name}: times must be rising numbers; times[{k + 1}] = {grid[k + 1]:g} s does not come after "
            f"{grid[k]:g} s"
        )
    if np.abs(grid).max() > LONGEST or not (len(grid) == 1 or np.ptp(grid) >= SHORTEST):
        raise ModelError(
            f"{m.name}: times are {grid[0]:g} .. {grid[-1]:g} s; they must span {SHORTEST:g} .. {LONGEST:g} s"
        )
    return grid


def _length(times: object) -> int:
    try:
        return len(times)  # pyright: ignore[reportArgumentType]
    except Exception:  # number_array() names a value that is no list
        return 0


def equal_times(m: Model, duration: float, steps: int) -> np.ndarray:
    """(T,) from 0 to ``duration`` (s) in ``steps`` equal steps, both ends included. Raises ModelError."""
    steps = whole_number(f"{m.name}: steps", steps)
    duration = finite_number(f"{m.name}: duration (s)", duration)
    if not duration > 0:
        raise ModelError(f"{m.name}: duration is {duration} s; it must be positive")
    if not SHORTEST <= duration <= LONGEST:
        raise ModelError(f"{m.name}: duration is {duration:g} s; it must be within {SHORTEST:g} .. {LONGEST:g} s")
    check_count(m, steps + 1)
    grid = np.arange(steps + 1) * (duration / steps)
    grid[-1] = duration
    return grid


def check_count(m: Model, count: int) -> None:
    """Raise ModelError where results at so many times do not fit into the memory of this machine."""
    joints = len(m.joints) + len(m.drivers) + len(m.contacts)
    numbers = 9 * len(m.bodies) + 3 * joints + 3 * len(m.drivers) + 8
    check_memory(f"{m.name}: results at {count:.6g} times", COPIES * numbers * count, "Take fewer steps or times")


@cache
def _memory() -> int:
    """Bytes that this machine has."""
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def check_memory(what: str, numbers: int, remedy: str) -> None:
    """Raise ModelError where so many numbers of 8 bytes are more than the memory of this machine."""
    memory = _memory()
    if 8 * numbers > memory:
        raise ModelError(
            f"{what} need about {8e-9 * float(numbers):.3g} GB, this machine has {1e-9 * memory:.3g} GB. {remedy}."
        )
