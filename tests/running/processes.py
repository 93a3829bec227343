"""The processes that run now, on any system, without the program ps."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil

from shared.stage.signals import end_with_parent

ENDS = 60.0
"""Seconds that a process has to end after SIGTERM."""


def command_lines() -> dict[int, str]:
    """Command line of every process, by its number; those that have ended and were not yet collected do not count."""
    running = (process.info for process in psutil.process_iter(["pid", "status", "cmdline"]))
    return {info["pid"]: " ".join(info["cmdline"] or ()) for info in running if info["status"] != psutil.STATUS_ZOMBIE}


def working_for(folder: Path) -> dict[int, str]:
    """Return the other processes whose command lines name a folder."""
    return {number: line for number, line in command_lines().items() if str(folder) in line and number != os.getpid()}


def ends_with_us() -> None:
    """For ``preexec_fn``: a process of tests that are killed gets SIGTERM, and is not left behind."""
    end_with_parent(signal.SIGTERM)


def until(is_so: Callable[[], object], seconds: float = 60.0) -> None:
    """Wait until something is so. Raises AssertionError after so many seconds."""
    end = time.monotonic() + seconds
    while not is_so():
        assert time.monotonic() < end, f"not so after {seconds:g} s"
        time.sleep(0.05)


def run_to_its_end(command: list[str], seconds: float, **options: Any) -> subprocess.CompletedProcess[str]:
    """Return the output of a command and its exit code.

    One that takes longer, or whose test is interrupted, is terminated.

    ``subprocess.run`` kills it, and then it can neither end what it has started nor unmount.
    """
    out = subprocess.PIPE
    with subprocess.Popen(command, stdout=out, stderr=out, text=True, preexec_fn=ends_with_us, **options) as process:
        try:
            said = process.communicate(timeout=seconds)
        except BaseException:
            process.terminate()
            try:
                process.communicate(timeout=ENDS)
            except subprocess.TimeoutExpired:
                process.kill()
            raise
        return subprocess.CompletedProcess(command, process.returncode, *said)
