"""Loop of a hunt: its command line, and its cases as they come in, shown, counted and written."""

from __future__ import annotations

import argparse
import math
import os
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Protocol

from shared.stage.console import progress, say, warn
from shared.stage.errors import UserError
from tools.hunt.outcome import CaseResult
from tools.hunt.pool import LIMIT

# What a hunt is asked for on the command line, by all hunts alike.


def parser(program: str, about: str | None, limit: float = LIMIT) -> argparse.ArgumentParser:
    """--n, --seed, --jobs, --kind, --limit and --case; ``limit``: seconds of one case if nothing is said."""
    made = argparse.ArgumentParser(
        prog=f"python -m {program}", description=about, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    made.add_argument("--n", type=_positive, default=1000)
    made.add_argument("--seed", type=int, default=1)
    made.add_argument("--jobs", type=_positive, default=os.cpu_count() or 1)
    made.add_argument("--kind")
    made.add_argument("--limit", type=float, default=limit, help="seconds of one case")
    made.add_argument("--case", type=int)
    return made


def refuse_unknown(kind: str | None) -> None:
    """Raise UserError for a kind of mechanism that there is not; None means all."""
    from tools.random_mechanisms.families import all_families

    if kind is None:
        return
    names = list(all_families())
    if kind not in names:
        raise UserError(f"there is no kind of mechanism '{kind}'; there is: {', '.join(names)}")


def _positive(text: str) -> int:
    number = int(text)
    if not 0 < number < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return number


# The cases of a hunt as they come in: shown, counted, and written now and then, so that nothing is lost.


SEEDS = 1_000_000
"""Cases of one --seed have numbers from seed * SEEDS on."""
EACH = 30.0
"""s after which the report is written again, so that a hunt that is killed loses little."""


class Report(Protocol):
    """Counts of a hunt."""

    @property
    def findings(self) -> Any:
        """Findings, as a sized thing."""
        ...

    def write(self, path: Path, seed: int, n: int, seconds: float) -> None:
        """Write the report."""
        ...

    def show(self, seconds: float) -> None:
        """Show it."""
        ...


def seeds(seed: int, n: int) -> range:
    """The numbers of the cases of one --seed."""
    return range(seed * SEEDS, seed * SEEDS + n)


def follow(
    program: str,
    tally: Report,
    path: Path,
    seed: int,
    n: int,
    arrived: Iterable[CaseResult],
    add: Callable[[CaseResult], list[str]],
) -> None:
    """Take in n results; ``add`` counts one and gives what is to be shown of it.

    Ctrl-C ends it with the report.
    """
    began = written = time.monotonic()
    name, stopped = program.rpartition(".")[2].replace("_", "-"), False
    try:
        with progress(name, n, "case") as shown:
            for result in arrived:
                for line in add(result):
                    warn(name, line)
                shown.advance(1, f"{len(tally.findings)} found" if tally.findings else "")
                if time.monotonic() - written > EACH:
                    tally.write(path, seed, n, time.monotonic() - began)
                    written = time.monotonic()
    except KeyboardInterrupt:
        stopped = True
    seconds = time.monotonic() - began
    tally.write(path, seed, n, seconds)
    tally.show(seconds)
    say(name, f"{path}; one case in detail: python -m {program} --case NUMBER")
    if stopped:
        raise KeyboardInterrupt
