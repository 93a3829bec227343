"""One round: a run with a fault at a random moment, the same command again, and what is to be true then."""

from __future__ import annotations

import random
import re
import shutil
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from render.blender.picture_file import is_as_named
from studio.night import runs
from tests.studio.night.torture.faults import BLENDER, FILM, MAKE, STAGE, Fault
from tests.studio.night.torture.hits import TARGETS
from tests.studio.night.torture.project import Project

HANG = 180.0
"""Seconds after which a run counts as hanging."""
ORPHANED = 15.0
"""Seconds that processes have to end after their make."""
POLL = 0.1
TRACEBACK = (
    r"^(?P<who>(?:[-0-9]+ [:0-9]+ )?(?:\[\d+\] )?(?:\w+: )?)Traceback \(most recent call last\):\n"
    r"(?:(?P=who)[ \t].*\n)*(?P=who)(?!KeyboardInterrupt)\S"
)
"""Python's own word for Ctrl-C while a program is still being loaded is none of ours."""
STATES = ("empty", "half", "finished")
LATEST = {"": 1.1, MAKE: 0.2, STAGE: 0.3, FILM: 0.25, BLENDER: 0.2, "ffmpeg": 0.01}
"""Latest moment of a fault after the start of the process that it needs, as a part of the time of a whole run."""


@dataclass
class Outcome:
    """Outcome of one round; all counts but the last three should be 0, ``twice`` at most 1."""

    fault: str
    target: str
    """Target of make: ``run-all`` in the terminal, ``overnight`` in the background."""
    state: str
    moment: float
    """Seconds after the start of the run, or of the process during which the fault hits."""
    hit: bool = False
    wrong: int = 0
    """Films that are not the reference, byte by byte, of a run that ended with code 0."""
    lost: int = 0
    """Whole pictures that were gone or rendered again although the fault had not touched them."""
    redone: int = 0
    """Pictures rendered again without need by the second run."""
    twice: int = 0
    """Pictures rendered more than once in both runs, those aside that the fault destroyed; one a fault may be in
    flight."""
    refused: int = 0
    """Second runs that did not end with code 0, and first ones that should have in spite of the fault."""
    hangs: int = 0
    orphans: int = 0
    left: list[str] = field(default_factory=list)
    """Command lines of the orphans."""
    leftovers: list[str] = field(default_factory=list)
    """Temporary files after the second run."""
    tracebacks: int = 0
    damaged: int = 0
    """Pictures that the fault destroyed, each of them rendered once more."""
    code: int = 0
    """Exit code of the run with the fault."""
    seconds: float = 0.0

    @property
    def bad(self) -> bool:
        """True if anything was wrong."""
        return bool(
            self.wrong + self.lost + self.redone + self.refused + self.hangs + self.orphans + self.tracebacks
        ) or bool(self.leftovers or self.twice > 1)

    def as_json(self) -> dict[str, Any]:
        """Return the outcome for the report."""
        return asdict(self)


def play(project: Project, fault: Fault, chance: random.Random, reference: list[bytes], length: float) -> Outcome:
    """One round; ``length`` is the time a whole run takes (s)."""
    started = time.monotonic()
    state = chance.choice(STATES[: 2 if fault.during else 3])
    moment = chance.uniform(0.0, LATEST[fault.during]) * length
    target = fault.target or chance.choice(TARGETS)
    outcome = Outcome(fault=fault.name, target=target, state=state, moment=round(moment, 2))
    _prepare(project, state, chance)
    project.clustered = fault.cluster
    project.clear_logs()
    if fault.before:
        fault.before(project)
    _faulted_run(project, fault, chance, outcome)
    outcome.refused += int(fault.ends_well and outcome.code != 0)
    if outcome.code == 0 and not fault.hits_film:
        outcome.wrong += _wrong(project, reference)
    if fault.undo:
        fault.undo(project)
    before = whole_pictures(project)
    outcome.damaged = len(project.pictures()) - len(before)
    outcome.refused += int(_run(project, outcome) != 0)
    project.clustered = False
    after = whole_pictures(project)
    outcome.wrong += _wrong(project, reference)
    if fault.follow:
        outcome.wrong += fault.follow(project)
    outcome.lost = sum(after.get(name) != at for name, at in before.items())
    keys = {name.partition("-")[0] for name in before}
    outcome.redone = sum(name.partition("-")[0] in keys for name in after if name not in before)
    renders = project.rendered()
    outcome.twice = max(0, len(renders) - len(set(renders)) - fault.destroys)
    outcome.leftovers = leftovers(project)
    outcome.tracebacks = len(re.findall(TRACEBACK, project.said(), re.MULTILINE))
    outcome.seconds = round(time.monotonic() - started, 2)
    return outcome


def whole_pictures(project: Project) -> dict[str, int]:
    """Names of the pictures that are what was rendered, and when they were written."""
    whole = {}
    for path in project.pictures():
        if is_as_named(path, path.read_bytes()):
            whole[path.name] = path.stat().st_mtime_ns
    return whole


def leftovers(project: Project) -> list[str]:
    """Return temporary files and folders below the results."""
    out = project.disk / "out"
    kept = {out / ".blender", out / ".blender" / "user", out / ".blender" / "cache"}
    left = []
    for path in out.rglob("*"):
        inside = {out / ".blender" / "user", out / ".blender" / "cache"} & set(path.parents)
        temporary = path.name.startswith((".", "tmp-")) and path.name not in (".stamps", ".lock")
        temporary = temporary and not (path.parent == runs.folder() and path.suffix == ".lock")  # locks stay
        if temporary and not inside and path not in kept:
            left.append(str(path.relative_to(out)))
    return left


def _prepare(project: Project, state: str, chance: random.Random) -> None:
    """Results as an earlier run left them: none, some of the pictures, or all; starts from a finished project."""
    if state == "finished":
        return
    pictures = sorted(project.pictures())
    for path in pictures if state == "empty" else chance.sample(pictures, len(pictures) // 2):
        path.unlink()
    films = project.films if state == "empty" else chance.sample(project.films, chance.randint(1, len(project.films)))
    for film in films:
        film.unlink(missing_ok=True)
    if state == "empty":
        for out in project.outs:
            shutil.rmtree(out.folder)


def _faulted_run(project: Project, fault: Fault, chance: random.Random, outcome: Outcome) -> None:
    """Run until the fault's moment, hit, and wait for the end of all processes."""
    project.start(outcome.target)
    begin = time.monotonic()
    while not project.is_over() and not any(fault.during in p.arguments for p in project.alive()):
        time.sleep(POLL / 4)
    due = time.monotonic() + outcome.moment
    while not project.is_over() and time.monotonic() < due:
        time.sleep(POLL / 4)
    while True:
        ended = project.is_over()
        outcome.hit = fault.hit(project, chance)  # once more after the end: files can be damaged then as well
        if outcome.hit or ended or time.monotonic() - begin > HANG:
            break
        time.sleep(POLL)
    outcome.code = _wait(project, outcome)


def _run(project: Project, outcome: Outcome) -> int:
    """Run the command once more, to its end."""
    project.start()
    return _wait(project, outcome)


def _wait(project: Project, outcome: Outcome) -> int:
    """Wait for the runs and all that they started; returns the exit code of the first."""
    begin = time.monotonic()
    while not project.is_over():
        if time.monotonic() - begin > HANG:
            outcome.hangs += 1
            break
        time.sleep(POLL)
    begin = time.monotonic()
    while not outcome.hangs and project.alive() and time.monotonic() - begin < ORPHANED:
        time.sleep(POLL)
    left = [] if outcome.hangs else project.alive()
    outcome.orphans += len(left)
    outcome.left += [process.arguments[:160] for process in left]
    code = -1 if outcome.hangs else project.code()
    project.kill()
    return code


def _wrong(project: Project, reference: list[bytes]) -> int:
    """Films that are not those of the undisturbed run, byte by byte."""
    return sum(_read(film) != right for film, right in zip(project.films, reference, strict=True))


def _read(path: Path) -> bytes:
    return path.read_bytes() if path.is_file() else b""
