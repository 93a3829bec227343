"""Ctrl-C while kernels call functions of the user.

Python handles a signal at the entry of whatever function it runs next. At the entry of one that a kernel calls nothing
can be raised, so the interrupt would be lost: it is kept instead, the function gives NaN, the kernel comes back, and
Callback.check raises.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import CodeType, FrameType

CALLED: set[CodeType] = set()
"""Functions that kernels call."""
_pending = threading.Event()


def taken() -> bool:
    """Return True if Ctrl-C came in a function that a kernel called, since it was last asked."""
    came = _pending.is_set()
    if came:
        _pending.clear()
    return came


@contextmanager
def kept() -> Iterator[None]:
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
    if taken():
        raise KeyboardInterrupt


def _on_interrupt(number: int, frame: FrameType | None) -> None:
    if frame is not None and frame.f_code in CALLED:
        _pending.set()
        return
    signal.default_int_handler(number, frame)
