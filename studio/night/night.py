"""Whole run: what is fresh, the work, the table of all at the end, and a truthful exit code."""

from __future__ import annotations

import subprocess
import time

from shared.contract.quantity import counted
from shared.stage.console import duration
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.paths import NAME_RULE, ROOT
from studio.night.coordinator import Coordinator
from studio.night.forecast import refuse_before_start
from studio.night.plan.freshness import fresh_steps
from studio.night.plan.options import Options
from studio.night.plan.steps import Board
from studio.night.runs import Log, Run, taken

STOPPED = 130
"""Exit code of a run that was asked to stop, as after Ctrl-C."""


def run(asked: Options) -> int:
    """Build all that ``asked`` names; 0 if all exists, 1 after a failure, 130 after a stop.

    Raises UserError where the folder of results cannot be used. A disk that is surely too small is reported; 1.
    """
    started = time.monotonic()
    with taken() as night, Log(night.number) as log:
        for word in asked.unfit:
            log.fail(f"mechanisms/{word} is not the name of a mechanism; rename the folder: {NAME_RULE}")
        board = Board(asked.names, fresh_steps(asked))
        work = sum(board.outcome(name) != "done" for name in asked.names)
        log.say(f"{counted(len(asked.names), 'mechanism')} at {asked.preset}, something to do for {work}")
        at_work = Coordinator(asked, night, log, board)
        try:
            refuse_before_start(asked, tuple(name for name in asked.names if board.outcome(name) != "done"))
            finished = at_work.go()
        except UserError as error:
            log.fail(str(error))
            at_work.books.close("failed", str(error))
            return 1
        except BaseException:
            at_work.books.close("stopped")
            log.say("stopped; what is finished is kept, the same command goes on from here")
            raise
        failed = [name for name in asked.names if board.outcome(name) == "failed"]
        at_work.books.close("stopped" if not finished else "failed" if failed or asked.unfit else "done")
        _table(asked, board, at_work, log)
        return _last_words(asked, board, failed, finished, night, log, time.monotonic() - started)


def _last_words(
    asked: Options, board: Board, failed: list[str], finished: bool, night: Run, log: Log, seconds: float
) -> int:
    """Print the sentence under the table and return the exit code."""
    done = sum(board.outcome(name) == "done" for name in asked.names)
    bad = [*failed, *("(an unfit name)" for _ in asked.unfit)]
    left = len(asked.names) - done - len(failed)
    words = f"{done} done" + (f", {left} not finished" if left else "")
    if bad:
        log.fail(f"{words}, failed: {' '.join(bad)}; their errors are above, {to_run('status')} shows the last of each")
    if not finished:
        log.say(f"stopped after {duration(seconds)}: {words}; the same command goes on from here")
        return STOPPED
    if not bad:
        log.say(f"{words} in {duration(seconds)}")
    return 1 if bad else 0


def _table(asked: Options, board: Board, at_work: Coordinator, log: Log) -> None:
    """Print the table of all runs, by the process that draws it."""
    rows = "".join(
        f"{name} {at_work.books.seconds(name):.1f} {board.outcome(name).replace(' ', '-')}\n" for name in asked.names
    )
    if not rows:
        return
    try:
        drawn = subprocess.run(
            [asked.python, "-m", "render", "overview"], cwd=ROOT, input=rows, capture_output=True, text=True, check=True
        )
    except (OSError, subprocess.CalledProcessError) as error:
        log.warn(f"the table could not be drawn: {error}")
        return
    for line in drawn.stdout.splitlines():
        log.relay(line)
