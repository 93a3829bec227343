"""A study on the cluster of the rounds, run as a module with ADDRESS FOLDER, and the faults that hit it."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections import Counter
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from shared.stage.paths import ROOT
from shared.stage.signals import end_with_parent

if TYPE_CHECKING:
    from mbsd import Mechanism
    from tests.studio.night.torture.project import Project

POINTS, SECONDS = 60, 0.3
"""Points of the study, and what each of them takes."""
PATIENCE = 120.0
"""Seconds that a study may take."""
COMPUTED = "computed.txt"


def build(length: float) -> Mechanism:
    """Return a bar."""
    from mbsd import Mechanism

    m = Mechanism("bar")
    m.bar("bar", length, mass=1.0)
    return m


def main() -> int:
    """Do the study; 1 with a sentence where that is not possible, 2 where the table is wrong."""
    import mbsd

    address, folder = sys.argv[1:]
    computed, seconds = str(Path(folder) / COMPUTED), SECONDS

    def measured(m: Mechanism) -> dict[str, float]:
        time.sleep(seconds)
        length = float(m.bodies["bar"].length or 0.0)
        handle = os.open(computed, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
        os.write(handle, f"{length:.3f}\n".encode())
        os.close(handle)
        return {"double": 2.0 * length}

    lengths = [0.001 * (n + 1) for n in range(POINTS)]
    try:
        table = mbsd.study(build, {"length": lengths}, measured, address, folder=folder, progress=False)
    except mbsd.ModelError as error:
        print(f"error: {error}")
        return 1
    return 0 if list(table["double"]) == [2.0 * length for length in lengths] else 2


def scheduler_killed(project: Project, chance: random.Random) -> bool:
    """Begin a study, and kill the scheduler when some of its points are computed."""
    if project.workers is None:
        return False
    place = _folder(project)
    study = _start(project)
    wanted, begin = chance.randrange(1, POINTS // 2), time.monotonic()
    while study.poll() is None and len(_computed(place)) < wanted and time.monotonic() - begin < PATIENCE:
        time.sleep(0.05)
    project.workers.scheduler.kill()
    _wait(study)
    return True


def study_again(project: Project) -> int:
    """The same study once more; what is wrong with both: no sentence, a wrong table, kept points computed again."""
    place = _folder(project)
    said = (place / "said.txt").read_text(errors="replace")
    lines = [line for file in place.glob("*/*.jsonl") for line in file.read_text().splitlines()]
    kept = sum(line.startswith("[") for line in lines)  # each file opens with the inputs of its points
    before = _computed(place)
    wrong = int("has gone; start it again" not in said) + said.count("Traceback (most recent call last)")
    wrong += int(_wait(_start(project)) != 0)
    again = _computed(place) - before
    wrong += int(again.total() > POINTS - kept)
    for file in sorted(place.rglob("*"), reverse=True):
        file.rmdir() if file.is_dir() else file.unlink()
    return wrong


def _folder(project: Project) -> Path:
    place = project.folder / "study"
    place.mkdir(exist_ok=True)
    return place


def _computed(place: Path) -> Counter[str]:
    path = place / COMPUTED
    return Counter(path.read_text().split()) if path.exists() else Counter()


def _start(project: Project) -> subprocess.Popen[bytes]:
    assert project.workers is not None
    place = _folder(project)
    with (place / "said.txt").open("ab") as said:
        return subprocess.Popen(
            [sys.executable, "-m", "tests.studio.night.torture.studies", project.workers.address, str(place)],
            cwd=ROOT, env=os.environ | {"PYTHONPATH": str(ROOT)}, stdin=subprocess.DEVNULL, stdout=said, stderr=said,
            preexec_fn=partial(end_with_parent, signal.SIGTERM),
        )  # fmt: skip


def _wait(study: subprocess.Popen[bytes]) -> int:
    try:
        return study.wait(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        study.kill()
        return study.wait()


if __name__ == "__main__":
    sys.exit(main())
