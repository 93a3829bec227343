"""Ends of a stage: signals that it hears, and its end with the make or the process that started it."""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

# Signals: SIGTERM and SIGHUP end a stage as Ctrl-C does, through its finally blocks.


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


# Link of a stage to make: a stage that make has started ends with make, however make ends.
#
# GNU make passes SIGTERM on to the commands it started, but no other signal, and a SIGKILL or a shell in between breaks
# the chain. Without a word from make its stages would go on rendering for hours.


VARIABLE = "MBSD_MAKE"
"""Environment variable in which the Makefile names the process of the outermost make."""
PERIOD = 0.5
"""Seconds between two looks at make."""
ended = False
"""True once the make above this process has ended, which stops this process."""
FATAL = (signal.SIGHUP, signal.SIGINT, signal.SIGQUIT, signal.SIGTERM)


def end_with_make() -> None:
    """Send this process SIGTERM as soon as its make has ended or got a signal to end.

    Does nothing if no make of this project is above, or if this process is itself the outermost one: like any program
    it then outlives the shell that started it with ``nohup`` or ``&``.
    """
    make = os.environ.get(VARIABLE, "")
    if make.isdigit() and int(make) != os.getpid():
        threading.Thread(target=_watch, args=(int(make), os.getppid()), daemon=True).start()


def _watch(make: int, parent: int) -> None:
    orphaned = parent == 1 != make
    global ended
    while not orphaned and os.getppid() == parent and _is_running(make) and not is_ending(make):
        time.sleep(PERIOD)
    ended = True
    os.kill(os.getpid(), signal.SIGTERM)


def is_ending(make: int) -> bool:
    """Return True if make only waits for its commands after a fatal signal.

    It blocks that signal and handles it no more.

    Only Linux shows it; elsewhere this is False, and the stage goes on until make has ended. A process that is about to
    start another one blocks all signals for a moment (posix_spawn and vfork do), and is not ending.
    """
    try:
        lines = Path(f"/proc/{make}/status").read_text().splitlines()
    except OSError:
        return False
    fields = {name: value.strip() for name, _, value in (line.partition(":") for line in lines)}
    if fields["State"].startswith("Z"):
        return True
    blocked, handled, ignored = (int(fields[name], 16) for name in ("SigBlk", "SigCgt", "SigIgn"))
    if blocked >> (signal.SIGSEGV - 1) & 1:
        return False
    return any((blocked & ~handled & ~ignored) >> (number - 1) & 1 for number in FATAL)


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
