"""Chunks of a study in processes of this machine. A process that is killed takes no study with it.

The processes get build and measure as bytes and import nothing of the script that started them, so a notebook or a
script without ``if __name__ == "__main__"`` serves as well.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor, Future
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.dependencies.recorder import Recorder
from mbsd.studies import work
from mbsd.studies.points import Point
from mbsd.studies.work import Done, Order

SINGLE = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
"""Each process works on one core."""


class Here:
    """One chunk after the other in this very process: breakpoints work."""

    slots = 1
    wave = 1
    target = 0.5
    """Seconds of one chunk."""

    def __init__(
        self, build: Callable[..., Any], measure: Callable[[Any], Any], recorder: Recorder | None = None
    ) -> None:
        self.build, self.measure, self.recorder = build, measure, recorder

    def submit(self, points: Sequence[Point]) -> Future[Done]:
        """Do a chunk now."""
        future: Future[Done] = Future()
        future.set_result(work.chunk_of(self.build, self.measure, self.recorder, points))
        return future

    def look_after(self) -> None:
        """There is nothing to look after."""

    def mend(self) -> None:
        """Nothing can break."""

    def close(self) -> None:
        """Nothing stays."""


class Processes:
    """Processes that take chunks; raises ModelError if the extra that brings them is missing."""

    target = 0.5
    wave = 2
    """Chunks under way for each process, so that none waits for the next."""

    def __init__(self, order: Order, count: int) -> None:
        self.order = order
        self.slots = count
        self._executor: Any = None

    def submit(self, points: Sequence[Point]) -> Future[Done]:
        """Hand out a chunk. The future raises BrokenExecutor if a process was killed."""
        if self._executor is None:
            self._executor = self._start()
        try:
            return self._executor.submit(work.chunk, self.order, points)
        except BrokenExecutor as error:
            future: Future[Done] = Future()
            future.set_exception(error)
            return future

    def look_after(self) -> None:
        """The executor tells of its processes by itself."""

    def mend(self) -> None:
        """New processes for those that are broken."""
        self.close()

    def close(self) -> None:
        """End all processes."""
        if self._executor is not None:
            self._executor.shutdown(wait=True, kill_workers=True)
            self._executor = None

    def _start(self) -> Any:
        try:
            from loky import ProcessPoolExecutor
        except ImportError as error:
            raise ModelError("study needs loky: install mbsd[study]") from error
        return ProcessPoolExecutor(self.slots, initializer=work.begin, initargs=(self.order,), env=SINGLE)
