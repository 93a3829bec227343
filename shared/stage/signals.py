"""Signals: SIGTERM and SIGHUP end a stage as Ctrl-C does, through its finally blocks."""

from __future__ import annotations

import ctypes
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

PR_SET_PDEATHSIG = 1
"""Number of the request in Linux's <sys/prctl.h>."""
AGAIN = 0.05
"""s until a signal comes again whose exception was lost."""


class Stopped(SystemExit):
    """Exit on a signal, with the code that shells expect (128 + number)."""

    def __init__(self, number: int) -> None:
        super().__init__(128 + number)


@contextmanager
def terminable() -> Iterator[None]:
    """Raise :class:`Stopped` at the first of either signal in this block.

    Later ones do not disturb the cleaning up.

    make and the shell may both pass the same signal on, so a second one means nothing. Where C calls Python back (numba
    does while it compiles), an exception is printed and lost; then the signal comes again a little later, and so does
    Ctrl-C.
    """

    def leave(number: int, _: FrameType | None) -> None:
        for other in before:
            signal.signal(other, signal.SIG_IGN)
        raise Stopped(number)

    before = {}
    try:
        for number in (signal.SIGTERM, signal.SIGHUP):
            before[number] = signal.getsignal(number)
            if before[number] is not signal.SIG_IGN:  # nohup asked for that
                signal.signal(number, leave)
    except ValueError:  # not the main thread, which alone gets signals
        yield
        return
    hook = sys.unraisablehook
    sys.unraisablehook = _coming_again(leave, hook)
    try:
        yield
    finally:
        sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, handler)


def end_with_parent(number: signal.Signals) -> None:
    """Send this process a signal when the thread that started it ends, however that ends (Linux alone)."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, number)


def _coming_again(
    leave: Callable[[int, FrameType | None], None], otherwise: Callable[[Any], object]
) -> Callable[[Any], None]:
    """Return a hook for exceptions that cannot be raised, which sends a lost signal again."""

    def lost(unraisable: Any) -> None:
        error = unraisable.exc_value
        if isinstance(error, Stopped):
            number = int(str(error.code)) - 128
            signal.signal(number, leave)
        elif isinstance(error, KeyboardInterrupt):
            number = int(signal.SIGINT)
        else:
            otherwise(unraisable)
            return
        main = threading.main_thread().ident
        timer = threading.Timer(AGAIN, signal.pthread_kill, (main, number))  # a real one: it ends what waits
        timer.daemon = True
        timer.start()

    return lost
