"""Processes as ps lists them, on Linux and on a Mac."""

from __future__ import annotations

import os
import signal
import subprocess
from contextlib import suppress
from dataclasses import dataclass


@dataclass(frozen=True)
class Process:
    """One process."""

    number: int
    group: int
    state: str
    arguments: str

    def send(self, what: signal.Signals) -> None:
        """Send a signal, if the process is still there."""
        with suppress(ProcessLookupError):
            os.kill(self.number, what)


def processes() -> list[Process]:
    """All that run now; those that have ended and were not yet collected do not count."""
    command = ["ps", "-axwwo", "pid=,pgid=,stat=,args="]
    listing = subprocess.run(command, capture_output=True, text=True, errors="replace", check=True).stdout
    alive = []
    for line in listing.splitlines():
        fields = line.split(maxsplit=3)
        if len(fields) == 4 and not fields[2].startswith("Z"):
            alive.append(Process(int(fields[0]), int(fields[1]), fields[2], fields[3]))
    return alive
