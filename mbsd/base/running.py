"""Long work of a thread that somebody may no longer want: it asks between its steps, and ends."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

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
    """Cores that this process may use, which a container or taskset may have made fewer."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
