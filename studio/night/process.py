"""One step as a process of its own: its output line by line, its silence, its end."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress

from shared.stage.lineage import VARIABLE
from shared.stage.paths import ROOT

BESIDE = 10
"""Niceness of what runs beside the render, which has the first claim on the cores."""
GRACE = 20.0
"""Seconds that a process has to clean up after SIGTERM."""
LINE = 4000
"""Longest line that is kept (bytes)."""


class Process:
    """Running step.

    Processes that it started end with it: its group here, Blender by its own watch on its parent.
    """

    def __init__(self, name: str, step: str, command: Sequence[str], beside: bool, environment: Mapping[str, str]):
        self.name, self.step = name, step
        self.started = time.monotonic()
        self.silence = 0.0
        """Seconds without a sign of life, counted in looks at it, so that a stop of this process itself is none."""
        self.signs = 0
        """Signs of life that it gave."""
        self.error = ""
        """The last line that begins with ``error:``."""
        self.hung = False
        """True if it was killed because it gave no sign of life."""
        self._rest = b""
        self._popen = subprocess.Popen(
            list(command),
            cwd=ROOT,
            env={**os.environ, **environment, VARIABLE: str(os.getpid())},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,  # Ctrl-C on the terminal reaches the night alone, which then ends its stages
        )
        assert self._popen.stdout is not None
        self._pipe = self._popen.stdout.fileno()
        os.set_blocking(self._pipe, False)
        if beside:
            with suppress(OSError):
                os.setpriority(os.PRIO_PROCESS, self._popen.pid, BESIDE)

    def lines(self) -> list[str]:
        """Return its output since the last call, in whole lines; after its end the rest as well."""
        ended = self._popen.poll() is not None
        blocks = [self._rest]
        with suppress(BlockingIOError):
            while block := os.read(self._pipe, 65536):
                blocks.append(block)
        *whole, self._rest = b"".join(blocks).split(b"\n")
        if (ended and self._rest) or len(self._rest) > LINE:
            whole, self._rest = [*whole, self._rest], b""
        said = [line[:LINE].decode(errors="replace").rstrip() for line in whole]
        for line in said:
            if line.startswith("error: "):
                self.error = line.removeprefix("error: ")
        return [line for line in said if line]

    def live(self, seconds: float, sign: bool) -> None:
        """Record that some seconds have passed, with or without a sign of life."""
        self.signs += sign
        self.silence = 0.0 if sign else self.silence + seconds

    def code(self) -> int | None:
        """Exit code, the negative number of a signal that ended it; None while it runs."""
        return self._popen.poll()

    def end(self, number: signal.Signals = signal.SIGTERM) -> None:
        """Send the signal to the process and its group."""
        if self._popen.poll() is None:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self._popen.pid, number)

    def wait(self) -> None:
        """Wait for its end, by force after :data:`GRACE`."""
        try:
            self._popen.wait(GRACE)
        except subprocess.TimeoutExpired:
            self.end(signal.SIGKILL)
            self._popen.wait()

    def close(self) -> None:
        """Close its pipe after its end."""
        assert self._popen.stdout is not None
        self._popen.stdout.close()
