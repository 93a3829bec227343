"""Says how a Blender process ended, or why it does not go on."""

from __future__ import annotations

import signal
import subprocess

ENDED = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
"""Signals by which somebody wishes it to end."""


class Silent(Exception):
    """The process gives no sign of life any more; the message is the first half of a sentence."""

    def __init__(self, message: str, remedy: str = "") -> None:
        super().__init__(message)
        self.remedy = remedy
        """What a user can do, if it comes again."""


def how_it_ended(code: int, doing: str, said: str) -> str:
    """The reason for an exit code other than 0, which is the negative number of a signal after a kill or crash.

    What Blender ``said`` last explains an error that it noticed itself, never a kill from outside.
    """
    lines = [line for line in said.strip().splitlines() if line.strip()]
    last = lines[-1].strip() if lines else "it said nothing"
    if code >= 0:
        return f"Blender ended with code {code} ({doing}): {last}"
    name = _signal_name(-code)
    if -code == signal.SIGKILL:
        return f"Blender was killed by {name} ({doing}): by the system if the memory ran out, else by a user"
    if -code in ENDED:
        return f"Blender was ended from outside by {name} ({doing}); the same command goes on from here"
    if -code == signal.SIGABRT:
        return f"Blender gave up by {name} ({doing}): {last}"
    return f"Blender crashed by {name} ({doing})"


def remedy_of(code: int) -> str:
    """What to do where Blender ends with this code again and again."""
    if -code == signal.SIGKILL:
        return "close other programs or take a smaller PRESET"
    return "make check tells the device"


def is_crash(code: int) -> bool:
    """Whether an exit code tells of a crash, or of a kill that is no wish of a user to end it."""
    return code < 0 and -code not in ENDED


def how_it_stands(process: int) -> str:
    """What the system says of a process that is silent, after a comma; nothing if there is nothing to say."""
    try:
        listing = subprocess.run(["ps", "-o", "stat=", "-p", str(process)], capture_output=True, text=True, timeout=5)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    state = listing.stdout.strip()[:1]
    if state == "T":
        return f", stopped by a signal: kill -CONT {process} lets it go on"
    if state == "D":
        return ", waits for a disk or a device"
    return ""


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
