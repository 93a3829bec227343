"""Link of a stage to make: a stage that make has started ends with make, however make ends.

GNU make passes SIGTERM on to the commands it started, but no other signal, and a SIGKILL or a shell in between breaks
the chain. Without a word from make its stages would go on rendering for hours.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from pathlib import Path

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
