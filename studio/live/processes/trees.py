"""Trees of processes: the descendants of one, and how all of them end, however detached."""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import psutil

MARK = "MBSD_LIVE"
"""Variable of the environment that all processes of a server have from it, with a value of its own."""
PR_SET_CHILD_SUBREAPER = 36
"""Number of the request in Linux's <sys/prctl.h>."""
ROUNDS, PAUSE = 400, 0.005
"""Looks at what is left, and seconds between them: new processes may begin while others are killed."""
MARKED = 5
"""Looks for what has the mark of a server that ends."""
STOPPED = (psutil.STATUS_STOPPED, psutil.STATUS_TRACING_STOP)


def adopt_orphans() -> None:
    """Keep all descendants below this process when their parents end (Linux alone)."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)


def below(process: int) -> list[int]:
    """Return the descendants of ``process``, including those that have ended but were not awaited."""
    numbers = []
    for child in _children(process):
        numbers += [child, *below(child)]
    return numbers


def end_below(process: int) -> None:
    """Kill all descendants of ``process``, also new ones; returns when none is left."""
    for _ in range(ROUNDS):
        left = below(process)
        for each in left:
            with suppress(ProcessLookupError, PermissionError):
                os.kill(each, signal.SIGKILL)
        for _ in reaped():
            pass
        if not left:
            return
        time.sleep(PAUSE)


def end_with_below(process: int) -> None:
    """Kill ``process`` and its descendants from outside."""
    with suppress(ProcessLookupError, PermissionError):
        os.kill(process, signal.SIGSTOP)  # so that it begins no other
    left = below(process)
    for each in [*left, process]:
        with suppress(ProcessLookupError, PermissionError):
            os.kill(each, signal.SIGKILL)


def end_marked(mark: str) -> None:
    """Kill all processes of this user with the server's ``mark``: those whose keeper was killed."""
    for _ in range(MARKED):
        left = []
        for process in psutil.process_iter():
            with suppress(psutil.Error, OSError):
                if process.pid != os.getpid() and process.environ().get(MARK) == mark:
                    process.kill()
                    left.append(process)
        if not left:
            return
        psutil.wait_procs(left, timeout=1.0)


def reaped() -> Iterator[tuple[int, int]]:
    """Yield ended children of this process with exit codes; signals are negative."""
    while True:
        try:
            child, status = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return
        if not child:
            return
        yield child, os.waitstatus_to_exitcode(status)


def is_stopped(process: int) -> bool:
    """Return True if a signal has stopped the process, so that it waits for another one."""
    try:
        return psutil.Process(process).status() in STOPPED
    except psutil.Error:
        return False


def _children(process: int) -> list[int]:
    children: list[int] = []
    try:
        for thread in os.listdir(f"/proc/{process}/task"):
            with suppress(OSError):
                children += map(int, Path(f"/proc/{process}/task/{thread}/children").read_text().split())
    except OSError:
        if not os.path.isdir("/proc/self/task"):
            with suppress(psutil.Error):
                return [child.pid for child in psutil.Process(process).children()]
    return children
