"""What a worker answers for a chunk: JSON, which runs nothing when it is read, and is believed only after checks."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any

from mbsd.dependencies.inputs import Inputs
from mbsd.studies import work
from mbsd.studies.points import REASON, Point
from mbsd.studies.work import Done, Order, Result

AROUND, OF_POINT = 4_000_000, 1_000_000
"""Bytes of an answer at most: beside its points, which is for the inputs, and for each of its points."""
LONGEST = 400
"""Characters of a text from elsewhere that a message shows."""


class WrongAnswer(Exception):
    """A worker sent something else than what it was asked for; the message tells what."""


def answer_of(order: Order, points: Sequence[Point], chunk: str) -> bytes:
    """Build and measure every point on a worker; ``chunk`` is the name under which this was asked for."""
    try:
        done = work.chunk(order, points)
        results = [[result.values, result.reason, result.passing] for result in done.results]
        answer = {"chunk": chunk, "seconds": done.seconds, "results": results, "inputs": done.inputs.states()}
        return json.dumps(answer, separators=(",", ":")).encode()
    except Exception as error:  # of what build and measure import, mostly
        return json.dumps({"chunk": chunk, "failed": f"{type(error).__name__}: {error}"[:10_000]}).encode()


def most_bytes(points: int) -> int:
    """Bytes that an answer for so many points has at most."""
    return AROUND + OF_POINT * points


def read(answer: Any, points: Sequence[Point], chunk: str) -> Done:
    """The results of these points in order, from the bytes that :func:`answer_of` gives.

    Raises WrongAnswer for an error of the worker, and for anything else than one result a point: names that are free,
    with numbers, or a reason.
    """
    if not isinstance(answer, bytes):
        raise WrongAnswer(f"it answers with {type(answer).__name__} where bytes were to be expected")
    if len(answer) > most_bytes(len(points)):
        raise WrongAnswer(f"its answer for {len(points)} points has {len(answer) / 1e6:.1f} MB")
    try:
        document = json.loads(answer)
    except (ValueError, RecursionError) as error:
        raise WrongAnswer(f"its answer cannot be read ({printable(str(error))})") from error
    if not isinstance(document, dict) or document.get("chunk") != chunk:
        raise WrongAnswer("it answers for another chunk")
    if "failed" in document:
        raise WrongAnswer(printable(str(document["failed"])))
    seconds, results = document.get("seconds"), document.get("results")
    if isinstance(seconds, bool) or not isinstance(seconds, int | float) or not 0.0 <= seconds < math.inf:
        raise WrongAnswer(f"it says that its work took {printable(str(seconds), 80)} s")
    if not isinstance(results, list) or len(results) != len(points):
        count = f"{len(results)} results" if isinstance(results, list) else type(results).__name__
        raise WrongAnswer(f"it answers with {count} for {len(points)} points")
    read_results = [_result(result, point) for result, point in zip(results, points, strict=True)]
    return Done(read_results, float(seconds), _inputs(document.get("inputs")))


def _inputs(states: Any) -> Inputs:
    """What the results depend on: states by name, for each kind of input."""
    if not isinstance(states, dict) or set(states) != set(Inputs().states()):
        raise WrongAnswer("it does not say what its results depend on")
    for named in states.values():
        if not isinstance(named, dict) or not all(isinstance(state, str) for state in named.values()):
            raise WrongAnswer("what its results depend on is not given by names and states")
    return Inputs(**states)


def _result(entry: Any, point: Point) -> Result:
    match entry:
        case [None, str() as reason, bool() as passing]:
            return Result(None, printable(reason, 10_000), passing)
        case [dict() as values, None, False]:
            for name, value in values.items():
                if name in point or name == REASON:
                    raise WrongAnswer(f"measure gives '{printable(name, 80)}', which is a column of the points")
                if not isinstance(value, bool | int | float):
                    raise WrongAnswer(f"it gives {type(value).__name__} as '{printable(name, 80)}', not a number")
            return Result(values)
    raise WrongAnswer("a result is neither numbers by name nor a reason")


def printable(text: str, longest: int = LONGEST) -> str:
    """A text from another machine for a message: one line of printable characters, cut where it is too long."""
    line = "".join(letter if letter.isprintable() else " " for letter in text[:longest])
    return " ".join(line.split()) + ("..." if len(text) > longest else "")
