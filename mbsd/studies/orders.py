"""Points of a study as orders to processes or a cluster, and checks of the answers.

An answer is JSON, which runs nothing when it is read.
"""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from functools import partial
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.dealing.deal import Deal
from mbsd.dealing.identity import Trust, asker, versions
from mbsd.dealing.manner import Kind, Manner
from mbsd.dealing.pools import Dask, Here, Processes
from mbsd.dealing.report import Report, WrongAnswer, encoded, printable
from mbsd.dependencies.inputs import Inputs
from mbsd.dependencies.recorder import Recorder
from mbsd.studies import work
from mbsd.studies.content import own_sources
from mbsd.studies.points import REASON, Point
from mbsd.studies.progress import VOICE
from mbsd.studies.simulated import Simulated
from mbsd.studies.work import Chunk, Order, Result

PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "cloudpickle")
"""Packages whose version decides the results, beside mbsd's own sources and Python."""
LOCAL = Manner(target=0.5, largest=2000, patience=math.inf, copies=1, first_alone=True)
TOGETHER = replace(LOCAL, target=2.0)
"""Simulations in one loop, which is made ready for each chunk: as much work as a hundred points."""
FAR = Manner(
    target=2.0, largest=2000, patience=60.0, unknown=600.0, endless=True, times=20.0, grace=60.0, failures=1,
    threads=True, first_alone=True,
)  # fmt: skip
OWN_MOST = 2**40
"""Bytes of the result of a point of this machine, which nobody needs to protect from."""
ENDED = "its process was ended, by the system if the memory ran out, else by what build or measure called"

Found = tuple[list[tuple[int, Result]], Inputs]
"""Results with the numbers of their points, and what they may depend on."""


@functools.cache
def identity() -> dict[str, str]:
    """Return the identity of this computer.

    It is kept for the process, so a worker reports what it was started with.
    """
    return versions(PACKAGES) | {"mbsd": own_sources()[:12]}


def manner_of(measure: object) -> Manner:
    """Return how points are handed to this machine."""
    return TOGETHER if isinstance(measure, Simulated) else LOCAL


def by_here(build: Callable[..., Any], measure: Callable[[Any], Any], recorder: Recorder | None) -> Deals:
    """Return points for this process, one after the other."""

    def computed(points: Numbered, _: Mapping[str, bytes]) -> bytes:
        return answered(partial(work.chunk_of, build, measure, recorder), points)

    return partial(_dealt, Here(), Kind(computed, (), own_result, OWN_MOST, inputs_of), manner_of(measure), None)


def by_processes(order: Order, count: int, manner: Manner) -> Deals:
    """Return points for processes of this computer.

    Raises ModelError if the extra that brings them is missing.
    """
    try:
        pool = Processes(count, work.begin, order)
    except ImportError as error:
        raise ModelError("study needs loky: install mbsd[study]") from error
    return partial(_dealt, pool, Kind(answer_of, (order,), own_result, OWN_MOST, inputs_of, _ended), manner, None)


def by_cluster(order: Order, client: Any, points: Sequence[Point]) -> Deals:
    """Return points for the workers of a cluster that are as this machine."""
    kind = Kind(answer_of, (order,), reader(points), MOST, inputs_of, _ended)
    trust = Trust(identity(), asker(__name__, "identity"))
    return partial(_dealt, Dask(client, strict=True), kind, FAR, trust)


def _ended(_: object) -> Result:
    return Result(None, ENDED, passing=True)


def _dealt(
    pool: Here, kind: Kind, manner: Manner, trust: Trust | None, todo: Mapping[int, Point]
) -> Generator[Found, None, None]:
    """Return the results of all points with their numbers as they come.

    Raises ModelError if no worker is left.
    """
    with closing(pool):
        for results, inputs, _ in Deal(pool, kind, todo, VOICE, manner, trust).parts():
            yield results, inputs or Inputs()


Deals = Callable[[Mapping[int, Point]], Generator[Found, None, None]]


MOST = 1_000_000
"""Bytes of the result of a point."""

Numbered = Sequence[tuple[int, Point]]


def answer_of(order: Order, points: Numbered, sent: Mapping[str, bytes] | None = None) -> bytes:
    """Build and measure every point on a worker, and return a Report as bytes.

    It fails for what build and measure import.
    """
    return answered(lambda chunk: work.chunk(order, chunk), points)


def answered(chunk_of: Callable[[list[Point]], Chunk], points: Numbered) -> bytes:
    """Return the report on these points. ``chunk_of`` computes them."""
    try:
        chunk = chunk_of([point for _, point in points])
    except Exception as error:
        return encoded(Report(failed=(points[0][0], f"{type(error).__name__}: {error}"[:10_000])))
    numbers = [number for number, _ in points]
    results = [_json([result.values, result.reason, result.passing]) for result in chunk.results]
    note = _json(chunk.inputs.states())
    return encoded(Report(done=list(zip(numbers, results, strict=True)), note=note, seconds=chunk.seconds))


def reader(points: Sequence[Point]) -> Callable[[int, bytes], Result]:
    """Return a reader of results: numbers under free names, or a reason. It raises WrongAnswer for others."""

    def read(number: int, content: bytes) -> Result:
        result = own_result(number, content)
        for name in result.values or ():
            if name in points[number] or name == REASON:
                raise WrongAnswer(f"measure gives '{printable(name, 80)}', which is a column of the points")
        return result if result.reason is None else result._replace(reason=printable(result.reason, 10_000))

    return read


def own_result(_: int, content: bytes) -> Result:
    """Return the result of a point.

    Raises WrongAnswer for anything else than numbers by name, or a reason.
    """
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
