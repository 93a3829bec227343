"""Watch over steps: how long one may be silent, and whether one that ended badly is tried again.

Blender itself is watched by the stage that renders, which starts it again where it hangs, crashes or grows
(render/blender/child.py). Here the stages are watched: one that hangs for other reasons is killed.
"""

from __future__ import annotations

import signal

from render.blender.process import Patience
from studio.night.process import Process

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
        return "it gave no sign of life and was killed"
    if process.error:
        return process.error
    if code < 0:
        try:
            name = signal.Signals(-code).name
        except ValueError:
            name = f"signal {-code}"
        return f"it was killed by {name}" + (", by the system if the memory ran out" if name == "SIGKILL" else "")
    return f"it ended with code {code}"
