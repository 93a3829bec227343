"""One step as a process of its own: its output line by line, its silence, its end."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress

from render.blender.process import Patience
from shared.stage.paths import ROOT
from shared.stage.signals import VARIABLE

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


# Watch over steps: how long one may be silent, and whether one that ended badly is tried again.
#
# Blender itself is watched by the stage that renders, which starts it again where it hangs, crashes or grows
# (render/blender/child.py). Here the stages are watched: one that hangs for other reasons is killed.


STAGE = 3600.0
"""Seconds without a word for a stage that is no render: a proof of clearance says nothing until its end."""
TWICE = 2.5
"""Multiple of the patience with Blender: the stage kills it twice before it gives up."""
TRIES = 2
"""Times that a step is started."""


def limit(renders: bool, each: float | None, pictures: int) -> float:
    """Return the seconds of silence after which a step is killed.

    ``renders``: pictures are its signs of life; it has made so many ``pictures``, and the forecast of one is ``each``
    (s). Before the first the drivers of a GPU may compile, which the stage itself has patience with.
    """
    patience = Patience(longest=each or 0.0, pictures=pictures)
    if not renders:
        return patience.scaled(STAGE)
    return TWICE * patience.limit("" if pictures else "kernels")


def is_tried_again(process: Process, tries: int) -> bool:
    """Return True if a failed step is started once more: after a hang, a crash or a kill from outside.

    An error that a stage reported in a sentence would come again.
    """
    code = process.code() or 0
    return tries < TRIES and (process.hung or code < 0)


def ending(process: Process) -> str:
    """Return the fault in half a sentence: the step's last error, else how it ended."""
    code = process.code() or 0
    if process.hung:
        return "it was silent for too long and was killed"
    if process.error:
        return process.error
    if code < 0:
        try:
            name = signal.Signals(-code).name
        except ValueError:
            name = f"signal {-code}"
        return f"it was killed by {name}" + (", by the system if the memory ran out" if name == "SIGKILL" else "")
    return f"it ended with code {code}"
