"""Compile the solver's kernels in the background: ``python -m tools.compiling begin``, or ``wait``.

begin   ``python -m mbsd compile`` in a process of its own, at the lowest priority, unless it is done or runs already
wait    until that has ended, and again here where it failed: tests and measurements want all kernels compiled

A stage that needs a kernel meanwhile compiles it by itself. Both write the same files, each renamed into place, so
neither waits for the other nor spoils its work. Ctrl-C ends make and its stages, not this: the next command wants the
kernels, too. What it says is in .venv/kernels.log; that it failed, or was killed, is reported by the next ``begin``.
"""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
DONE, LOG, LOCK = (ROOT / ".venv" / name for name in ("kernels-compiled", "kernels.log", "kernels.lock"))
COMMAND = [sys.executable, "-m", "mbsd", "compile"]


def begin() -> int:
    """Start it; the process holds the lock until it ends, however it ends."""
    lock = os.open(LOCK, os.O_RDWR | os.O_CREAT, 0o644)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return 0
    if DONE.exists():
        return 0
    if LOG.exists():
        said = LOG.read_text(errors="replace").strip().splitlines() or ["nothing was said"]
        print(
            f"warning: kernels were not compiled in the background: {said[-1]} ({LOG}). Trying again", file=sys.stderr
        )
    print("install: compiling the solver's kernels in the background; what needs one sooner compiles it by itself")
    with LOG.open("wb") as log:
        subprocess.Popen(
            [sys.executable, "-m", "tools.compiling", "run"],
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            pass_fds=[lock],
        )
    return 0


def wait() -> int:
    """Return when all kernels are compiled; the exit status is that of the compilation."""
    lock = os.open(LOCK, os.O_RDWR | os.O_CREAT, 0o644)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        print("install: waiting for the solver's kernels", flush=True)
        fcntl.flock(lock, fcntl.LOCK_EX)
    return 0 if DONE.exists() else compiled()


def compiled() -> int:
    """Compile, and note it where that succeeds."""
    status = subprocess.call(COMMAND, cwd=ROOT)
    if status == 0:
        DONE.touch()
    return status


def main() -> int:
    """The exit status."""
    match sys.argv[1:]:
        case ["begin"]:
            return begin()
        case ["wait"]:
            try:
                return wait()
            except KeyboardInterrupt:
                return 130
        case ["run"]:
            os.nice(19)
            return compiled()
    print("usage: python -m tools.compiling begin | wait", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
