"""Check that a file shows the mechanism as it is now, by the author's files and the stages' records.

``python -m mechanisms current`` tells whose motion, parts and shot follow from the author's files as they are; the
stamps of the stages tell what other results were made of (shared/stage/stages.py).
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from shared.contract import Parts
from shared.contract.clearance import Clearance, read_clearance
from shared.stage.console import say, warn
from shared.stage.face import to_run
from shared.stage.paths import ROOT, Out
from shared.stage.stages import is_recorded, outdated_by

SILENCE = 300.0
"""Seconds that all mechanisms may take to be asked."""


class Freshness:
    """Knows which results of some mechanisms are current; it looks when one of them is first shown."""

    def __init__(self, names: Sequence[str]) -> None:
        self._names = list(names)
        self._current: set[str] | None = None

    def is_current(self, name: str) -> bool:
        """Return True if motion, parts and shot of a mechanism follow from its files as they are."""
        if self._current is None:
            self._current = current_names(self._names)
        return name in self._current

    def why_older(self, out: Out, path: Path) -> str:
        """Return why a file is out of date, as part of a sentence; empty if it is not."""
        if not path.is_file():
            return "it is not there"
        if not is_recorded(out, path):
            return "no stage has recorded what it was made of"
        if not self.is_current(out.name):
            return "the machine has changed since it was solved"
        changed = outdated_by(out, path)
        if path.name in changed:
            return "it is not as a stage left it"
        return f"it is of an older {' and '.join(changed)}" if changed else ""


def current_names(names: Sequence[str]) -> set[str]:
    """Return the mechanisms whose results follow from their files.

    There are none, with a warning, if that takes long. Asked in a process of its own, for mechanism.py may do anything
    there.
    """
    if not names:
        return set()
    words, said = [sys.executable, "-m", "mechanisms", "current", *names], ""
    try:
        done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, timeout=SILENCE, check=False)
        current = set(done.stdout.split()) & set(names)
        if done.returncode:
            said = (done.stderr.strip() or f"exit code {done.returncode}").splitlines()[-1]
    except subprocess.TimeoutExpired:
        current, said = set(), f"no answer within {SILENCE:.0f} s"
    if said:
        warn(
            "current",
            f"which results are of an older version is not known of all, so the others count as older: {said}",
        )
    return current


def clearance_files(out: Out) -> list[Path]:
    """Return clearance.json if it is of the motion and the parts beside it; else nothing."""
    return [out.clearance] if out.clearance.is_file() and not outdated_by(out, out.clearance) else []


def current_clearance(out: Out, parts: Parts | None, stage: str) -> Clearance | None:
    """Return the clearance of a machine with parts, unless motion or parts have changed since.

    ``stage`` then reports the change.

    Raises UserError for a file that cannot be read.
    """
    if parts is None or not out.clearance.is_file():
        return None
    if changed := outdated_by(out, out.clearance):
        remedy = to_run("clearance", out.name)
        say(stage, f"{out.name}: the clearance is of an older {' and '.join(changed)}, so it is left out; {remedy}")
        return None
    return read_clearance(out.clearance)
