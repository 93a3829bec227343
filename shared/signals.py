"""SIGTERM and SIGHUP leave like Ctrl-C does: through the finally blocks, so that nothing is left behind."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class Stopped(SystemExit):
    """Raised by a signal that ends the program, with the exit code shells expect (128 + number)."""

    def __init__(self, number: int) -> None:
        super().__init__(128 + number)


@contextmanager
def terminable() -> Iterator[None]:
    """Inside this block the first of either signal raises :class:`Stopped`; later ones do not disturb the cleaning up.

    make and the shell may both pass the same signal on, so a second one means nothing.
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
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
