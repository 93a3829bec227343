"""Keeper: the parent of a process with the author's code, which it ends with all its descendants.

It does so when asked to, when the server is gone however that ended, or when too much memory is taken.

The author's code can hold Python's lock for ever or begin processes of sessions of their own, so what ends them is not
in their process. ``python -m studio.live.processes.keeper NICE COMMAND ...`` keeps a program; the end of its standard
input is the server's word.
"""

from __future__ import annotations

import os
import resource
import select
import signal
import sys
import traceback
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

from shared.stage.signals import end_with_parent
from studio.live.processes.trees import adopt_orphans, below, end_below, reaped

PERIOD = 0.25
"""Seconds between two looks at memory, or where the system cannot tell of a process's end, at that."""
PAGE = resource.getpagesize()


def begin(work: Callable[[], int]) -> int:
    """Fork a process that does ``work`` and exits with its code; return its number.

    It dies with this one.
    """
    adopt_orphans()
    keeper = os.getpid()
    child = os.fork()
    if child:
        return child
    code = 1
    try:
        end_with_parent(signal.SIGKILL)
        os.setsid()  # signals that it sends to its group are its own affair
        if os.getppid() == keeper:
            code = work()
    except BaseException:
        traceback.print_exc()
    finally:
        with suppress(Exception):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(code)


def keep(child: int, server: int, most_bytes: int | None = None) -> tuple[int | None, int]:
    """Wait until ``child`` ends or must end, and end all that is left below this process.

    ``server`` is a descriptor that ends with the server, or when the server asks for it. Returns the exit code of
    the child, negative for signals, or None if it was ended here; and its bytes, if those were too many, else 0.
    """
    poll = select.poll()
    poll.register(server, select.POLLIN | select.POLLHUP)
    ending = _pidfd(child)
    if ending is not None:
        poll.register(ending, select.POLLIN)
    code, used = None, 0
    while True:
        events = dict(poll.poll(1000 * PERIOD))
        for number, ended in reaped():
            if number == child:
                code = ended
        if code is not None or server in events:
            break
        if most_bytes is not None:
            used = resident(child)
            if used > most_bytes / 2:  # what it has begun counts, too
                used += sum(map(resident, below(child)))
            if used > most_bytes:
                break
            used = 0
    end_below(os.getpid())
    return code, used


def resident(process: int) -> int:
    """Return the bytes of a process that are in memory; 0 if it has ended."""
    try:
        return int(Path(f"/proc/{process}/statm").read_text().split()[1]) * PAGE
    except (OSError, IndexError, ValueError):
        pass
    if os.path.isdir("/proc/self"):
        return 0
    import psutil

    try:
        return psutil.Process(process).memory_info().rss
    except psutil.Error:
        return 0


def _pidfd(process: int) -> int | None:
    try:
        return os.pidfd_open(process)
    except (AttributeError, OSError):
        return None


def main() -> NoReturn:
    """Run a program under this keeper."""
    nice, *command = sys.argv[1:]
    os.nice(int(nice))

    def run() -> int:
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        os.execvp(command[0], command)

    code, _ = keep(begin(run), 0)
    os._exit(0 if code is None else code if code >= 0 else 128 - code)


if __name__ == "__main__":
    main()
