"""Work that runs: ended when nobody waits for it, interrupted by Ctrl-C, and not done twice.

Long work of a thread asks between its steps whether it is still wanted.

Python handles Ctrl-C at the entry of whatever function it runs next. At the entry of one that a kernel calls nothing
can be raised, so the interrupt would be lost: it is kept instead, the function gives NaN, the kernel comes back, and
Callback.check raises.

Results of functions of numbers alone are kept by these numbers as bytes. Nothing gets stale, as all that a result
depends on is in its key.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from types import CodeType, FrameType
from typing import Generic, TypeVar

_OWN = threading.local()


class Stopped(BaseException):
    """Nobody waits for what this thread does."""


@contextmanager
def stops_when(unwanted: Callable[[], bool]) -> Iterator[None]:
    """Let what this thread does within the block end as soon as ``unwanted``; then Stopped is raised."""
    before = getattr(_OWN, "unwanted", None)
    _OWN.unwanted = unwanted
    try:
        yield
    finally:
        _OWN.unwanted = before


def end_if_unwanted() -> None:
    """Raise Stopped if this thread's work is no longer wanted."""
    unwanted = getattr(_OWN, "unwanted", None)
    if unwanted is not None and unwanted():
        raise Stopped


def cores() -> int:
    """Return cores that this process may use, which a container or taskset may have made fewer."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


CALLED: set[CodeType] = set()
"""Functions that kernels call."""
_pending = threading.Event()


def was_interrupted() -> bool:
    """Return True if Ctrl-C came in a function that a kernel called, since it was last asked."""
    came = _pending.is_set()
    if came:
        _pending.clear()
    return came


@contextmanager
def keeping_interrupts() -> Iterator[None]:
    """Keep interrupts that could not be raised; where the program has a handler of its own, that stands."""
    main = threading.current_thread() is threading.main_thread()
    if not main or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    _pending.clear()
    signal.signal(signal.SIGINT, _on_interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if was_interrupted():
        raise KeyboardInterrupt


def _on_interrupt(number: int, frame: FrameType | None) -> None:
    if frame is not None and frame.f_code in CALLED:
        _pending.set()
        return
    signal.default_int_handler(number, frame)


T = TypeVar("T")
MOST = 64
"""Number of results of one function that are kept; the oldest go first."""


class Kept(Generic[T]):
    """Results by key. Who gets one does not write into it."""

    def __init__(self) -> None:
        self._results: dict[Hashable, T] = {}
        self._changing = threading.Lock()

    def get(self, key: Hashable, find: Callable[[], T]) -> T:
        """Return what ``find`` returned for this key before, or returns now; errors are not kept."""
        with self._changing:
            if key in self._results:
                return self._results[key]
        result = find()
        with self._changing:
            while len(self._results) >= MOST:
                del self._results[next(iter(self._results))]
            self._results[key] = result
        return result
