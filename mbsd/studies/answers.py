"""Answers of workers for a group of points, and their checks: JSON, which runs nothing when read."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from mbsd.dealing.report import Report, encoded
from mbsd.dealing.wrong_answer import WrongAnswer, printable
from mbsd.dependencies.inputs import Inputs
from mbsd.studies import work
from mbsd.studies.points import REASON, Point
from mbsd.studies.work import Done, Order, Result

MOST = 1_000_000
"""Bytes of the result of a point."""

Numbered = Sequence[tuple[int, Point]]


def answer_of(order: Order, points: Numbered, sent: Mapping[str, bytes] | None = None) -> bytes:
    """Build and measure every point on a worker. A Report as bytes; it fails for what build and measure import."""
    return answered(lambda chunk: work.chunk(order, chunk), points)


def answered(done_of: Callable[[list[Point]], Done], points: Numbered) -> bytes:
    """The report on these points. ``done_of`` computes them."""
    try:
        done = done_of([point for _, point in points])
    except Exception as error:
        return encoded(Report(failed=(points[0][0], f"{type(error).__name__}: {error}"[:10_000])))
    numbers = [number for number, _ in points]
    results = [_json([result.values, result.reason, result.passing]) for result in done.results]
    note = _json(done.inputs.states())
    return encoded(Report(done=list(zip(numbers, results, strict=True)), note=note, seconds=done.seconds))


def reader(points: Sequence[Point]) -> Callable[[int, bytes], Result]:
    """Reads the result of a point: names that are free, with numbers, or a reason. Raises WrongAnswer for others."""

    def read(number: int, content: bytes) -> Result:
        result = own_result(number, content)
        for name in result.values or ():
            if name in points[number] or name == REASON:
                raise WrongAnswer(f"measure gives '{printable(name, 80)}', which is a column of the points")
        return result if result.reason is None else result._replace(reason=printable(result.reason, 10_000))

    return read


def own_result(_: int, content: bytes) -> Result:
    """The result of a point. Raises WrongAnswer for anything else than numbers by name, or a reason."""
    match _read(content):
        case [None, str() as reason, bool() as passing]:
            return Result(None, reason, passing)
        case [dict() as values, None, False]:
            for name, value in values.items():
                if not isinstance(value, bool | int | float):
                    raise WrongAnswer(f"it gives {type(value).__name__} as '{printable(name, 80)}', not a number")
            return Result(values)
    raise WrongAnswer("a result is neither numbers by name nor a reason")


def inputs_of(note: bytes) -> Inputs:
    """Return the inputs of results: states by name, for each kind. Raises WrongAnswer for anything else."""
    states = _read(note)
    if not isinstance(states, dict) or set(states) != set(Inputs().states()):
        raise WrongAnswer("it does not say what its results depend on")
    for named in states.values():
        if not isinstance(named, dict) or not all(isinstance(state, str) for state in named.values()):
            raise WrongAnswer("what its results depend on is not given by names and states")
    return Inputs(**states)


def _json(value: Any) -> bytes:
    return json.dumps(value, separators=(",", ":")).encode()


def _read(content: bytes) -> Any:
    try:
        return json.loads(content)
    except (ValueError, RecursionError) as error:
        raise WrongAnswer(f"its answer cannot be read ({printable(str(error))})") from error
