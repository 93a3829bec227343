"""Points of a study as orders: to this process, to processes of this machine, or to the workers of a cluster."""

from __future__ import annotations

import functools
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
from mbsd.dependencies.inputs import Inputs
from mbsd.dependencies.recorder import Recorder
from mbsd.studies import work
from mbsd.studies.answers import MOST, Numbered, answer_of, answered, inputs_of, own_result, reader
from mbsd.studies.identity.content import own_sources
from mbsd.studies.points import Point
from mbsd.studies.simulated import Simulated
from mbsd.studies.voice import VOICE
from mbsd.studies.work import Order, Result

PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "cloudpickle")
"""Those whose version decides what comes out, beside mbsd's own sources and Python."""
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
    """Return the identity of this computer; kept for the process, so a worker reports what it was started with."""
    return versions(PACKAGES) | {"mbsd": own_sources()[:12]}


def manner_of(measure: object) -> Manner:
    """How points are handed to this machine."""
    return TOGETHER if isinstance(measure, Simulated) else LOCAL


def by_here(build: Callable[..., Any], measure: Callable[[Any], Any], recorder: Recorder | None) -> Deals:
    """Points for this process, one after the other."""

    def computed(points: Numbered, _: Mapping[str, bytes]) -> bytes:
        return answered(partial(work.chunk_of, build, measure, recorder), points)

    return partial(_dealt, Here(), Kind(computed, (), own_result, OWN_MOST, inputs_of), manner_of(measure), None)


def by_processes(order: Order, count: int, manner: Manner) -> Deals:
    """Points for processes of this machine. Raises ModelError if the extra that brings them is missing."""
    try:
        pool = Processes(count, work.begin, order)
    except ImportError as error:
        raise ModelError("study needs loky: install mbsd[study]") from error
    return partial(_dealt, pool, Kind(answer_of, (order,), own_result, OWN_MOST, inputs_of, _ended), manner, None)


def by_cluster(order: Order, client: Any, points: Sequence[Point]) -> Deals:
    """Points for the workers of a cluster that are as this machine."""
    kind = Kind(answer_of, (order,), reader(points), MOST, inputs_of, _ended)
    trust = Trust(identity(), asker(__name__, "identity"))
    return partial(_dealt, Dask(client, strict=True), kind, FAR, trust)


def _ended(_: object) -> Result:
    return Result(None, ENDED, passing=True)


def _dealt(
    pool: Here, kind: Kind, manner: Manner, trust: Trust | None, todo: Mapping[int, Point]
) -> Generator[Found, None, None]:
    """The results of all points with their numbers as they come. Raises ModelError where no worker is left."""
    with closing(pool):
        for results, inputs, _ in Deal(pool, kind, todo, VOICE, manner, trust).parts():
            yield results, inputs or Inputs()


Deals = Callable[[Mapping[int, Point]], Generator[Found, None, None]]
