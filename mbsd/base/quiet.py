"""Warnings silenced while a block runs, in any number of threads at once.

``warnings.catch_warnings`` puts back what it found, which another thread may have silenced meanwhile: the last that
leaves would leave all warnings silent. Here the first that enters silences them, and the last that leaves puts back.
"""

from __future__ import annotations

import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

_LOCK = threading.Lock()
_within: list[warnings.catch_warnings[None]] = []
"""What puts back, once for each block that runs; the first alone did anything."""


@contextmanager
def quiet() -> Iterator[None]:
    """Show no warnings as long as any such block runs."""
    with _LOCK:
        caught = warnings.catch_warnings() if not _within else _within[0]
        if not _within:
            caught.__enter__()
            warnings.simplefilter("ignore")
        _within.append(caught)
    try:
        yield
    finally:
        with _LOCK:
            _within.pop()
            if not _within:
                caught.__exit__(None, None, None)
