"""``make torture``: a night of films at the size of a postage stamp, rendered while things go wrong.

--n 100 --seed 1    a hundred rounds: a run of make with a random fault at a random moment (kills, a full disk, damaged
                    files, two runs at once), then the same command again, which has to end with the right films;
                    the run is make run-all or make overnight; some with three workers of a cluster, some of them beside
                    a fourth that answers with rubbish, one with a study whose scheduler is killed
--only fetch        faults with this word in their names alone
--keep              keep the project's folder after a round that went wrong, and end there

Exit code 1 if a film was wrong or short, a picture was lost or more than one rendered twice in a round, a run hung or
ended in a traceback, or a process or temporary file stayed. The report is also in out/torture.json.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path

from shared.stage.console import run_cli, say, warn
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import out_root
from shared.system.missing import missing_programs, program, sentence
from tests.studio.loopback_ssh import machine
from tests.studio.night.torture import fetching
from tests.studio.night.torture.faults import BACKGROUND, CLUSTER, DISK_OF_ONE, FAULTS, FETCH, FULL, Fault
from tests.studio.night.torture.project import Project
from tests.studio.night.torture.rounds import Outcome, play
from tests.studio.night.torture.workers import Workers

ROUNDS, SEED = 20, 1
COUNTS = ("wrong", "lost", "redone", "twice", "refused", "hangs", "orphans", "tracebacks")


def main() -> int:
    """Play the rounds, report, and say by the exit code whether anything went wrong."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.studio.night.torture",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--n", type=_count, default=ROUNDS)
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--only", default="", help="faults with this word in their names")
    parser.add_argument("--keep", action="store_true")
    arguments = parser.parse_args()
    report = out_root() / "torture.json"  # before the project sets a folder of its own
    project = Project(Path(tempfile.mkdtemp(prefix="mbsd-torture-")).resolve())
    outcomes: list[Outcome] = []
    kept, closing = False, ExitStack()
    try:
        project.build()
        reference, length = _reference(project)
        faults = [
            *FAULTS,
            *CLUSTER,
            *([*FULL, *DISK_OF_ONE] if project.mounted else []),
            *(BACKGROUND if program("tmux") else []),
        ]
        if fetching.is_possible():
            place = closing.enter_context(tempfile.TemporaryDirectory(prefix="mbsd-ssh-"))
            other = closing.enter_context(machine(Path(place) / "machine"))
            os.environ["MBSD_TORTURE_RSH"] = other.shell()
            faults += FETCH
        else:
            lacking = missing_programs(fetching.PROGRAMS)
            warn("torture", f"{sentence(programs=lacking)}; so no film is fetched")
        if not project.mounted:
            warn(
                "torture", "a small disk can be mounted by root alone, so no disk gets full; the tests do that as well"
            )
        faults = [fault for fault in faults if arguments.only in fault.name]
        if not faults:
            raise UserError(f"torture: no fault of this machine has {arguments.only!r} in its name")
        for number, fault in _rounds(faults, arguments.n, arguments.seed):
            if fault.cluster and project.workers is None:
                place = Path(closing.enter_context(tempfile.TemporaryDirectory(prefix="mbsd-workers-")))
                project.workers = Workers(place)
                closing.callback(project.workers.close)
            outcome = play(project, fault, random.Random(f"{arguments.seed} {number}"), reference, length)
            outcomes.append(outcome)
            say("torture", f"{number + 1}/{arguments.n}: {_words(outcome)}")
            if outcome.bad:
                warn("torture", f"round {number + 1} of seed {arguments.seed}: {json.dumps(outcome.as_json())}")
                print(project.said())
                if arguments.keep:
                    kept = True
                    break
                project.forget()
                _reference(project)
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # a second Ctrl-C would leave mounts and processes
        closing.close()
        if kept:
            say("torture", f"kept: {project.folder}")
        else:
            project.remove()
        code = _report(outcomes, arguments.seed, report)  # of what was played, if it was stopped
    return code


def _rounds(faults: Sequence[Fault], count: int, seed: int) -> Iterator[tuple[int, Fault]]:
    """Number and fault of each round: every fault comes once before one comes again."""
    chance = random.Random(seed)
    hat: list[Fault] = []
    for number in range(count):
        if not hat:
            hat = chance.sample(faults, len(faults))
        yield number, hat.pop()


def _reference(project: Project) -> tuple[list[bytes], float]:
    """Return the films of an undisturbed run, and its duration (s)."""
    begin = time.monotonic()
    code = project.start().wait(timeout=300)
    if code:
        raise UserError(f"the undisturbed run ended with code {code}:\n{project.said()}")
    length = time.monotonic() - begin
    project.kill()
    return [film.read_bytes() for film in project.films], length


def _words(outcome: Outcome) -> str:
    hit = f"after {outcome.moment:.1f} s" if outcome.hit else "nothing to hit"
    then = f"code {outcome.code}" + (f", {outcome.damaged} pictures destroyed" if outcome.damaged > 0 else "")
    return f"{outcome.fault} ({outcome.target}, {outcome.state}, {hit}): {then}, {'WRONG' if outcome.bad else 'right'}"


def _report(outcomes: list[Outcome], seed: int, path: Path) -> int:
    """Say the sums and write the file; 1 if anything went wrong."""
    sums = {name: sum(getattr(outcome, name) for outcome in outcomes) for name in COUNTS}
    sums["leftovers"] = sum(len(outcome.leftovers) for outcome in outcomes)
    seconds = sum(outcome.seconds for outcome in outcomes)
    document = {
        "seed": seed,
        "rounds": len(outcomes),
        "hit": sum(outcome.hit for outcome in outcomes),
        **sums,
        "destroyed by faults": sum(max(outcome.damaged, 0) for outcome in outcomes),
        "seconds": round(seconds, 1),
        "overnight": sum(outcome.target == "overnight" for outcome in outcomes),
        "faults": dict(sorted(Counter(outcome.fault for outcome in outcomes).items())),
        "outcomes": [outcome.as_json() for outcome in outcomes],
    }
    write_bytes(path, json.dumps(document, indent=1).encode() + b"\n")
    words = ", ".join(f"{name} {count}" for name, count in sums.items())
    say("torture", f"{len(outcomes)} rounds in {seconds:.0f} s, {document['hit']} faults hit: {words}")
    return int(any(outcome.bad for outcome in outcomes))


def _count(text: str) -> int:
    """Return a number of rounds."""
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text} rounds; give 1 or more")
    return number


if __name__ == "__main__":
    run_cli(main)
