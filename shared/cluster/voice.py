"""Messages of a stage on its workers: lines on the console, and UserError."""

from __future__ import annotations

from functools import partial

from mbsd.dealing.manner import Voice
from shared.stage.console import duration, say, warn
from shared.stage.errors import UserError
from shared.stage.face import to_run


def stage_voice() -> Voice:
    """Return the messages, with commands of the program through which the stage was called."""
    return Voice(
        say=partial(say, "cluster"),
        warn=partial(warn, "cluster"),
        error=UserError,
        duration=duration,
        no_scheduler=(
            f"no scheduler answers at CLUSTER={{where}} ({{problem}}); start one with {to_run('scheduler')}, or leave "
            "CLUSTER out to work on this machine alone"
        ),
        gone="the scheduler has gone; nothing was lost, the same command goes on",
        silent=(
            "the scheduler has been silent for {time}; nothing was lost, start it again "
            f"({to_run('scheduler')}), and then the same command"
        ),
        nobody=(
            "no worker of the cluster can do this{shown}; start workers with the same lock file and sources "
            f"({to_run('worker')}), or leave CLUSTER out"
        ),
        without="there is no worker that can do this",
        one_comes=f"one is given {{time}} to come ({to_run('worker')})",
        lied="worker {worker} sent a wrong answer: {reason}; it is left out, others do its work",
        failed="worker {worker}: {reason}",
        left_out="worker {worker}: {reason}; it is left out",
    )
