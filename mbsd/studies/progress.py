"""Progress of a study, and its messages about workers.

Progress is a bar where rich is installed and a terminal listens, a line now and then everywhere else.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from mbsd.base.errors import ModelError
from mbsd.base.warning import warn
from mbsd.dealing.manner import Voice

SHORTEST, LONGEST = 5.0, 60.0
"""Seconds between two lines; the gap grows with the time that has passed."""

Tell = Callable[[int, int], None]
"""Called with the points done and failed, those done now."""


@contextmanager
def progress(total: int, known: int, shown: bool) -> Iterator[Tell]:
    """Yield what reports each chunk; ``known`` of the ``total`` points were there before."""
    if not shown or total == known:
        yield lambda done, failed: None
        return
    pace = _Pace(total, known)
    if sys.stderr.isatty():
        try:
            from rich.console import Console
            from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
        except ImportError:
            pass
        else:
            words = TextColumn("{task.fields[words]}")
            columns = TextColumn("study"), BarColumn(), MofNCompleteColumn(), words
            with Progress(*columns, console=Console(stderr=True)) as bar:
                task = bar.add_task("study", total=total, completed=known, words="")

                def tell(done: int, failed: int) -> None:
                    pace.count(done, failed)
                    bar.update(task, completed=pace.done, words=pace.words())

                yield tell
            return
    yield _Lines(pace).tell


class _Pace:
    def __init__(self, total: int, known: int) -> None:
        self.total, self.known = total, known
        self.done, self.failed = known, 0
        self.counted: int | None = None
        self.started = time.monotonic()

    def count(self, done: int, failed: int) -> None:
        self.done += done
        self.failed += failed
        if self.counted is None:  # the first chunk loads and compiles, which says nothing of the others
            self.counted, self.started = self.done, time.monotonic()

    def words(self) -> str:
        passed = time.monotonic() - self.started
        each = passed / max(self.done - (self.counted or 0), 1)
        left = f"{duration(each * (self.total - self.done))} left" if self.done < self.total else "done"
        failed = f", {self.failed} failed" if self.failed else ""
        known = f", {self.known} were known" if self.known and self.done == self.total else ""
        pace = f"{1 / each:.3g} points a second, " if each > 1e-9 and self.done > (self.counted or 0) else ""
        return f"{pace}{left if pace or self.done == self.total else 'begun'}{failed}{known}"


class _Lines:
    def __init__(self, pace: _Pace) -> None:
        self.pace, self.last = pace, pace.started

    def tell(self, done: int, failed: int) -> None:
        pace, now = self.pace, time.monotonic()
        pace.count(done, failed)
        gap = min(max(SHORTEST, 0.05 * (now - pace.started)), LONGEST)
        if pace.done >= pace.total or now - self.last >= gap:
            self.last = now
            print(f"study: {pace.done}/{pace.total}, {pace.words()}", file=sys.stderr, flush=True)


def duration(seconds: float) -> str:
    """Return a time for people: ``12 s``, ``3 min 20 s``, ``2 h 05 min``."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    return f"{whole // 60} min {whole % 60:02d} s" if whole < 3600 else f"{whole // 3600} h {whole // 60 % 60:02d} min"


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
