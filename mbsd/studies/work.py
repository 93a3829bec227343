"""What a worker does: builds and measures a chunk of points, whatever goes wrong with one of them."""

from __future__ import annotations

import hashlib
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from mbsd.base.errors import ModelError
from mbsd.base.shown import shown
from mbsd.base.users_function import described
from mbsd.studies.points import Point

PASSING = (OSError, MemoryError)
"""Failures of the machine: such a point is computed anew the next time."""


class Result(NamedTuple):
    """What a point came to: numbers by name, or the reason why there are none."""

    values: dict[str, float | int | bool] | None
    reason: str | None = None
    passing: bool = False
    """Whether the machine failed, not the point."""


class Done(NamedTuple):
    """A chunk's results in order, and the seconds it took."""

    results: list[Result]
    seconds: float


_functions: dict[str, tuple[Callable[..., Any], Callable[[Any], Any]]] = {}
"""Build and measure of this process, by the hash of their bytes."""


def begin(functions: bytes) -> None:
    """Load build and measure, and what solving needs, once in a process."""
    import mbsd.dynamics.simulate
    import mbsd.kinematics.sweep  # noqa: F401

    loaded(functions)


def loaded(functions: bytes) -> tuple[Callable[..., Any], Callable[[Any], Any]]:
    """Build and measure from their bytes. Raises what their modules raise where they are not installed."""
    key = hashlib.sha256(functions).hexdigest()
    if key not in _functions:
        import cloudpickle

        _functions.clear()
        _functions[key] = cloudpickle.loads(functions)
    return _functions[key]


def chunk(functions: bytes, points: Sequence[Point]) -> Done:
    """Build and measure every point, with functions from their bytes."""
    return chunk_of(*loaded(functions), points)


def chunk_of(build: Callable[..., Any], measure: Callable[[Any], Any], points: Sequence[Point]) -> Done:
    """Build and measure every point. Warnings of the single points are not shown."""
    started = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = [result_of(build, measure, point) for point in points]
    return Done(results, time.perf_counter() - started)


def result_of(build: Callable[..., Any], measure: Callable[[Any], Any], point: Point) -> Result:
    """One point; whatever build or measure raise is its reason."""
    try:
        return Result(_numbers(measure(build(**point))))
    except Exception as error:
        return Result(None, described(error), isinstance(error, PASSING))


def _numbers(measured: Any) -> dict[str, float | int | bool]:
    if not isinstance(measured, Mapping):
        raise ModelError(f"measure gives {shown(measured)}; it must give names and numbers {{name: number}}")
    out = {}
    for name, value in measured.items():
        if hasattr(value, "item") and getattr(value, "size", 0) == 1:
            value = value.item()
        if not isinstance(name, str) or not isinstance(value, bool | int | float):
            raise ModelError(f"measure gives {shown(value)} as {shown(name)}; it must be a number under a name")
        out[name] = value
    return out
