"""Work of one process: it builds and measures a chunk of points, whatever goes wrong with one of them.

Build and measure travel as bytes that need no file of the user where they are read.
"""

from __future__ import annotations

import functools
import hashlib
import importlib
import io
import sys
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from mbsd.base.arguments import described
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.dependencies.inputs import Inputs
from mbsd.dependencies.installed import is_installed
from mbsd.dependencies.recorder import Recorder
from mbsd.dependencies.recording import recording
from mbsd.studies.inputs import StudyPlaces, is_of_mbsd, recorded_inputs
from mbsd.studies.points import Point
from mbsd.studies.simulated import Simulated

PASSING = (OSError, MemoryError)
"""Failures of the machine: such a point is computed anew the next time."""


class Result(NamedTuple):
    """Result of a point: numbers by name, or the reason why there are none."""

    values: dict[str, float | int | bool] | None
    reason: str | None = None
    passing: bool = False
    """True if the machine failed, not the point."""


class Chunk(NamedTuple):
    """A chunk's results in order, its seconds, and all that its process has read for this study so far."""

    results: list[Result]
    seconds: float
    inputs: Inputs


class Order(NamedTuple):
    """Points and functions of a study that a process gets."""

    functions: bytes
    """Build and measure."""
    root: str | None
    """The folder relative to which files are named that they read; None where nothing is kept."""
    call: str
    """Another text for each call of ``study``, between which modules of the user may have changed."""

    def recorder(self) -> Recorder | None:
        """Return a record of what build and measure read; None if nothing is kept."""
        return None if self.root is None else Recorder(StudyPlaces(Path(self.root)))


class Work(NamedTuple):
    """Build and measure, ready to be called."""

    build: Callable[..., Any]
    measure: Callable[[Any], Any]
    recorder: Recorder | None


_work: dict[str, Work] = {}
"""Work of this process, by a hash of the order."""
_before: set[str] = set()
"""Modules that were loaded before the first study."""


def begin(order: Order) -> None:
    """Load build and measure, and what solving needs, once in a process."""
    import mbsd.dynamics.simulate
    import mbsd.kinematics.sweep  # noqa: F401

    loaded(order)


def loaded(order: Order) -> Work:
    """Build and measure from their bytes. Raises what their modules raise where they are not installed."""
    key = f"{hashlib.sha256(order.functions).hexdigest()} {order.call}"
    if key not in _work:
        import cloudpickle

        _forget_modules()
        _work.clear()
        recorder = order.recorder()
        with recording(recorder) if recorder else nullcontext():
            build, measure = cloudpickle.loads(order.functions)
        _work[key] = Work(build, measure, recorder)
    return _work[key]


def _forget_modules() -> None:
    """Forget modules of the user that an earlier study loaded: their files may have changed."""
    if not _before:
        _before.update(sys.modules)
    importlib.invalidate_caches()
    for name, module in list(sys.modules.items()):
        file = getattr(module, "__file__", None)
        if name not in _before and isinstance(file, str) and not is_installed(file) and not is_of_mbsd(file):
            del sys.modules[name]


def chunk(order: Order, points: Sequence[Point]) -> Chunk:
    """Build and measure every point, with functions from their bytes."""
    return chunk_of(*loaded(order), points)


def chunk_of(
    build: Callable[..., Any], measure: Callable[[Any], Any], recorder: Recorder | None, points: Sequence[Point]
) -> Chunk:
    """Build and measure every point. Warnings of the single points are not shown."""
    started = time.perf_counter()
    with warnings.catch_warnings(), recording(recorder) if recorder else nullcontext():
        warnings.simplefilter("ignore")
        if isinstance(measure, Simulated):
            results = _together(build, measure, points)
        else:
            results = [result_of(build, measure, point) for point in points]
    inputs = recorded_inputs(recorder) if recorder else Inputs()
    return Chunk(results, time.perf_counter() - started, inputs)


def _together(build: Callable[..., Any], measure: Simulated, points: Sequence[Point]) -> list[Result]:
    """Build all, then measure all that there are at once."""
    built: dict[int, Any] = {}
    results: dict[int, Result] = {}
    for number, point in enumerate(points):
        try:
            built[number] = build(**point)
        except Exception as error:
            results[number] = Result(None, described(error), isinstance(error, PASSING))
    if built:
        measured = measure.of_all(list(built.values()))
        results |= {number: Result(*row) for number, row in zip(built, measured, strict=True)}
    return [results[number] for number in range(len(points))]


def result_of(build: Callable[..., Any], measure: Callable[[Any], Any], point: Point) -> Result:
    """Return the result of one point; whatever build or measure raise is its reason."""
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


def bytes_of(build: Any, measure: Any, modules: dict[str, ModuleType]) -> bytes:
    """Build and measure with what they use of ``modules``. Raises ModelError where that cannot be sent."""
    try:
        import cloudpickle
    except ImportError as error:
        raise ModelError("study needs cloudpickle: install mbsd[study]") from error
    by_value = [module for name, module in modules.items() if name != "__main__"]

    class Pickler(cloudpickle.CloudPickler):
        """Takes cached functions along, too, with an empty cache; by itself pickle names their module."""

        def reducer_override(self, obj: Any) -> Any:
            wrapped = getattr(obj, "__wrapped__", None)
            if type(obj) is functools._lru_cache_wrapper and getattr(wrapped, "__module__", None) in modules:  # pyright: ignore[reportAttributeAccessIssue]
                return _cached, (wrapped, obj.cache_parameters())
            return super().reducer_override(obj)

    for module in by_value:
        cloudpickle.register_pickle_by_value(module)
    try:
        content = io.BytesIO()
        Pickler(content).dump((build, measure))
        return content.getvalue()
    except Exception as error:
        raise ModelError(f"study: build or measure cannot be sent to another process: {error}") from error
    finally:
        for module in by_value:
            cloudpickle.unregister_pickle_by_value(module)


def _cached(function: Callable[..., Any], parameters: dict[str, Any]) -> Callable[..., Any]:
    return functools.lru_cache(**parameters)(function)
