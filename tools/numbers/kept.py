"""Numbers of all runs, kept in a file, and how far others are from them.

    difference of an array = max |a - b| / scale,   scale = max(max |a|, max |b|, 1e-6 max of all numbers of the run)

The last term says what is zero: a reaction of 1e-13 N in a mechanism with forces of 100 N is rounding.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from shared.stage.files import write_bytes
from tools.numbers.contents import contents

ZERO = 1e-6
"""Fraction of a run's largest number below which an array counts as small."""
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?", re.IGNORECASE)


class Numbers(msgspec.Struct, array_like=True):
    """An array."""

    dtype: str
    shape: tuple[int, ...]
    data: bytes

    def array(self) -> np.ndarray:
        """The array itself."""
        return np.frombuffer(self.data, self.dtype).reshape(self.shape)


Run = dict[str, list[Numbers | str]]
"""By name; what a run has several times under one name stands in its order."""


def kept(result: Any) -> Run:
    """Return what is kept of a result."""
    run: Run = {}
    for name, value in contents(result):
        plain = value if isinstance(value, str) else Numbers(str(value.dtype), value.shape, value.tobytes())
        run.setdefault(name, []).append(plain)
    return run


def keep(file: Path, runs: dict[str, Run]) -> None:
    """Write the runs into a file."""
    file.parent.mkdir(parents=True, exist_ok=True)
    write_bytes(file, msgspec.msgpack.encode(runs))


def read(file: Path) -> dict[str, Run]:
    """Return the runs in a file.

    Raises OSError where there is none and msgspec.DecodeError for what is no such file.
    """
    return msgspec.msgpack.decode(file.read_bytes(), type=dict[str, Run])


def farthest(before: Run, now: Run) -> tuple[float, str]:
    """Return the largest difference between two results of a run, and where it is.

    It is infinite where something is missing.
    """
    largest = ZERO * max((_largest(value) for run in (before, now) for value in _all(run)), default=0.0)
    worst = (0.0, "")
    for name in before.keys() | now.keys():
        ours, theirs = before.get(name, []), now.get(name, [])
        if len(ours) != len(theirs):
            return math.inf, f"{name}: {len(ours)} before, {len(theirs)} now"
        for a, b in zip(ours, theirs, strict=True):
            worst = max(worst, (_difference(a, b, largest), name), key=lambda pair: pair[0])
    return worst


def _all(run: Run) -> Iterator[np.ndarray]:
    for values in run.values():
        yield from (value.array() for value in values if not isinstance(value, str))


def _largest(values: np.ndarray) -> float:
    if not np.issubdtype(values.dtype, np.inexact):
        return 0.0
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))


def _difference(a: Numbers | str, b: Numbers | str, least: float) -> float:
    if isinstance(a, str) or isinstance(b, str):
        return _of_texts(a, b) if isinstance(a, str) and isinstance(b, str) else math.inf
    return _of_arrays(a.array(), b.array(), least)


def _of_arrays(a: np.ndarray, b: np.ndarray, least: float) -> float:
    """Whole numbers and truths must be the same, and so must the places of what is not finite."""
    if a.shape != b.shape or not np.issubdtype(a.dtype, np.inexact):
        return 0.0 if np.array_equal(a, b) else math.inf
    finite = np.isfinite(a)
    if not np.array_equal(finite, np.isfinite(b)) or not np.array_equal(a[~finite], b[~finite], equal_nan=True):
        return math.inf
    apart = float(np.abs(a[finite] - b[finite]).max(initial=0.0))
    return apart / max(_largest(a), _largest(b), least) if apart else 0.0


def _of_texts(a: str, b: str) -> float:
    """Words must be the same; numbers within them, which are rounded, may differ in their last digit."""
    if a == b:
        return 0.0
    if NUMBER.sub("#", a) != NUMBER.sub("#", b):
        return math.inf
    pairs = zip(map(float, NUMBER.findall(a)), map(float, NUMBER.findall(b)), strict=True)
    return max(abs(x - y) / max(abs(x), abs(y)) for x, y in pairs if x != y)
