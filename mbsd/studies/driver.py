"""Hands out points in chunks of a length that fits their cost, and finds the point that ends a process."""

from __future__ import annotations

import math
import queue
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import BrokenExecutor, Future, wait
from typing import Protocol

from mbsd.dependencies.inputs import Inputs
from mbsd.studies.points import Point
from mbsd.studies.work import Done, Result

MOST = 2000
"""Points of a chunk."""
WAIT = 0.5
"""Seconds between two looks at the workers."""
ENDED = "its process was ended, by the system if the memory ran out, else by what build or measure called"

Numbered = list[tuple[int, Point]]
Part = tuple[list[tuple[int, Result]], Inputs]
"""Results with the numbers of their points, and what they may depend on."""


class Workers(Protocol):
    """Who takes chunks: this process, processes beside it, or a cluster."""

    target: float
    wave: int

    @property
    def slots(self) -> int:
        """Chunks that are worked on at the same time."""
        ...

    def submit(self, points: Sequence[Point]) -> Future[Done]:
        """Hand out a chunk."""
        ...

    def look_after(self) -> None:
        """Called now and then."""
        ...

    def mend(self) -> None:
        """Go on after BrokenExecutor."""
        ...

    def close(self) -> None:
        """Leave nothing behind."""
        ...


def computed(workers: Workers, todo: Numbered) -> Iterator[Part]:
    """The results of all points with their numbers, chunk by chunk as they come."""
    left, away = deque(todo), dict[Future[Done], Numbered]()
    ended: queue.SimpleQueue[Future[Done]] = queue.SimpleQueue()
    each = math.inf
    first = True
    while left or away:
        # What the first point needs is compiled once; the others load it.
        most = 1 if first else workers.slots * workers.wave
        while left and len(away) < most:
            size = 1 if first else _size(each, len(left), workers)
            part = [left.popleft() for _ in range(size)]
            future = workers.submit([point for _, point in part])
            away[future] = part
            future.add_done_callback(ended.put)
        workers.look_after()
        try:
            future = ended.get(timeout=WAIT)
        except queue.Empty:
            continue
        if future not in away:
            continue
        try:
            done = future.result()
        except BrokenExecutor:
            suspects = list(away.values())
            away.clear()
            workers.mend()
            for part in suspects:
                yield from _one_by_one(workers, part)
            continue
        part = away.pop(future)
        pace = done.seconds / len(part)
        # The first one loads and compiles, which says nothing of the others.
        each = math.inf if first else pace if math.isinf(each) else 0.7 * each + 0.3 * pace
        first = False
        yield _numbered(part, done)


def _numbered(part: Numbered, done: Done) -> Part:
    return [(number, result) for (number, _), result in zip(part, done.results, strict=True)], done.inputs


def _size(each: float, left: int, workers: Workers) -> int:
    """Points of the next chunk: as many as take the wished time, and all workers end at about the same time."""
    if math.isinf(each):
        return 1
    fair = math.ceil(left / (2 * workers.slots))
    return max(1, min(fair, MOST, left, int(workers.target / max(each, 1e-9))))


def _one_by_one(workers: Workers, part: Numbered) -> Iterator[Part]:
    """A chunk that may have ended a process: halved until the point that does so stands alone."""
    try:
        done = _awaited(workers, workers.submit([point for _, point in part]))
    except BrokenExecutor:
        workers.mend()
        if len(part) == 1:
            yield [(part[0][0], Result(None, ENDED, passing=True))], Inputs()
            return
        for half in (part[: len(part) // 2], part[len(part) // 2 :]):
            yield from _one_by_one(workers, half)
        return
    yield _numbered(part, done)


def _awaited(workers: Workers, future: Future[Done]) -> Done:
    """The result; meanwhile the workers are looked after, as one may go and its chunk with it."""
    while not wait([future], timeout=WAIT).done:
        workers.look_after()
    return future.result()
