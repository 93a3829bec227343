"""Keeper of a worker: Dask's worker ends with its scheduler, and another one waits for the next."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Sequence
from contextlib import suppress
from functools import partial

from shared.stage.console import say
from shared.stage.signals import end_with_parent, terminable

PAUSE = 1.0
"""s between the end of a worker and its successor, which itself waits until a scheduler answers."""
END = 20.0
"""s in which a worker ends that was asked to."""


def keep(command: Sequence[str], scheduler: str) -> int:
    """Run Dask's worker by ``command`` again and again; return its exit code after an error.

    SIGTERM, SIGHUP or Ctrl-C end it, and the worker with it. The worker gets SIGTERM if this process is killed.
    """
    with terminable():
        while True:
            code = _run(command)
            if code != 0:
                return code if code > 0 else 128 - code
            say("cluster", f"the scheduler {scheduler} has gone; this worker waits until it is back (Ctrl-C ends it)")
            time.sleep(PAUSE)


def _run(command: Sequence[str]) -> int:
    process = subprocess.Popen(
        command,
        start_new_session=True,  # Ctrl-C on the terminal reaches us alone
        preexec_fn=partial(end_with_parent, signal.SIGTERM),
    )
    try:
        return process.wait()
    finally:
        if process.poll() is None:
            process.terminate()
            try:
                process.wait(END)
            except subprocess.TimeoutExpired:
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)
                process.wait()
