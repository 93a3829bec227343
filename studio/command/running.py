"""Stages of a command, run one after the other as processes; the first that fails ends it."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from shared.stage.lineage import VARIABLE
from shared.stage.paths import ROOT
from shared.stage.signals import Stopped, terminable
from studio.command.plan import plan_line

GRACE = 20.0
"""Seconds that a stage has to clean up when the command is stopped."""


@dataclass
class Outcome:
    """One stage that ran."""

    stage: str
    code: int
    seconds: float


@dataclass
class Run:
    """Stages of a command; ``quiet`` sends their output to stderr, ``planned`` only lists them."""

    environment: Mapping[str, str]
    quiet: bool = False
    planned: bool = False
    done: list[Outcome] = field(default_factory=list)

    def all_of(self, commands: Iterable[Sequence[str]]) -> int:
        """Run the stages; return the exit code of the first that fails, else 0."""
        for words in commands:
            code = self.one(words)
            if code != 0:
                return code
        return 0

    def one(self, words: Sequence[str]) -> int:
        """Run one stage to its end and return its exit code.

        A stop is passed on, and ends the command when the stage has ended.
        """
        if self.planned:
            print(plan_line(words), flush=True)
            return 0
        began = time.monotonic()
        sys.stdout.flush()
        process = subprocess.Popen(
            list(words), cwd=ROOT, env=self._environment(), stdout=sys.stderr if self.quiet else None
        )
        try:
            with terminable():
                code = process.wait()
        except (Stopped, KeyboardInterrupt):
            _end(process)
            raise
        code = 128 - code if code < 0 else code
        self.done.append(Outcome(" ".join(words[3:4]) or words[2], code, round(time.monotonic() - began, 3)))
        return code

    def output_of(self, words: Sequence[str]) -> list[str] | None:
        """Return the lines that a stage prints; None if it fails, which it has reported."""
        done = subprocess.run(list(words), cwd=ROOT, env=self._environment(), stdout=subprocess.PIPE, text=True)
        return done.stdout.splitlines() if done.returncode == 0 else None

    def last(self, words: Sequence[str]) -> int:
        """Run one stage in place of this process, so that keys and signals reach it."""
        if self.planned or self.quiet or os.name != "posix":
            return self.one(words)
        os.chdir(ROOT)
        sys.stdout.flush()
        return os.execve(words[0], list(words), self._environment())

    def _environment(self) -> dict[str, str]:
        own = {VARIABLE: os.environ.get(VARIABLE) or str(os.getpid())}
        paths = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH", ""))))
        return {**os.environ, **self.environment, **own, "PYTHONPATH": paths}


def _end(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(GRACE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
