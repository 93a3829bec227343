"""Messages of a study about its workers: warnings that point at the user's line, and ModelError."""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.base.warning import warn
from mbsd.dealing.voice import Voice
from mbsd.studies.progress import duration

_GONE = (
    "the scheduler {where} has gone; start it again (make scheduler). What is computed is kept where there is a "
    "folder, the same call goes on from there"
)
_LEFT_OUT = "worker {worker} is left out: {reason}; others do its work"

VOICE = Voice(
    say=lambda text: None,  # a bar shows how far the study is
    warn=lambda text: warn(f"study: {text}", UserWarning),
    error=lambda text: ModelError(f"study: {text}"),
    duration=duration,
    no_scheduler="no scheduler answers at {where} ({problem}); start one (docs/cluster.md) or leave client out",
    gone=_GONE,
    silent=_GONE,
    nobody=(
        "no worker of {where} can compute it{shown}; start workers with the same lock file (docs/cluster.md). What is "
        "computed is kept"
    ),
    without="{where} has no worker that can compute it",
    one_comes="one is given {time} to come",
    lied=_LEFT_OUT,
    failed="worker {worker}: {reason}",
    left_out=_LEFT_OUT,
)
