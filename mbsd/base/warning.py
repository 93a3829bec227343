"""Warnings that point at the user's line, whichever of our functions finds their reason.

Warnings silenced while a block runs, in any number of threads at once.

``warnings.catch_warnings`` puts back what it found, which another thread may have silenced meanwhile: the last that
leaves would leave all warnings silent. Here the first that enters silences them, and the last that leaves puts back.
"""

from __future__ import annotations

import sys
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from mbsd.base.errors import PACKAGE


def warn(message: str, category: type[Warning]) -> None:
    """Warn with the line of the first caller outside this package."""
    if sys.version_info >= (3, 12):
        warnings.warn(message, category, skip_file_prefixes=PACKAGE)
    else:
        warnings.warn(message, category, stacklevel=_depth_of_user(sys._getframe()))


def _depth_of_user(frame: FrameType) -> int:
    """Return the number of frames from ``frame`` out to the first one outside this package.

    ``frame`` counts; it is the outermost if none is outside.
    """
    depth = 1
    while frame.f_code.co_filename.startswith(PACKAGE) and frame.f_back is not None:
        frame, depth = frame.f_back, depth + 1
    return depth


_LOCK = threading.Lock()
_within: list[warnings.catch_warnings[None]] = []
"""Contexts that restore warnings, one for each block that runs; only the first changed anything."""


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
