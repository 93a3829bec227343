"""A few rounds of the torture; `make torture N=100` plays more."""

from __future__ import annotations

import json
import os
import random
import re
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from shared.stage.paths import ROOT
from tests.running.processes import ends_with_us, run_to_its_end, working_for
from tests.studio.night.torture.damage import cut, flipped, no_text
from tests.studio.night.torture.faults import BACKGROUND, CLUSTER, DISK_OF_ONE, FAULTS, FETCH, FULL
from tests.studio.night.torture.rounds import TRACEBACK, Outcome


@pytest.mark.slow
def test_two_rounds(out_root: Path, tmp_path: Path) -> None:
    """Faults at random moments lose nothing; the seed is fixed, so that it is the same test each day.

    Where a small disk can be mounted, one of the two rounds fills it, and the other has no memory.
    """
    done = run_to_its_end(
        [sys.executable, "-m", "tests.studio.night.torture", "--n", "2", "--seed", "10596"], 400.0,
        cwd=ROOT, env=os.environ | {"MBSD_OUT": str(out_root), "TMPDIR": str(tmp_path)},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    report = json.loads((out_root / "torture.json").read_bytes())
    assert report["rounds"] == len(report["outcomes"]) == 2
    counts = ("wrong", "lost", "redone", "refused", "hangs", "orphans", "tracebacks", "leftovers")
    assert [report[name] for name in counts] == [0] * len(counts)
    assert report["twice"] <= report["hit"]  # the current frame
    assert not working_for(tmp_path)
    assert not list(tmp_path.glob("mbsd-torture-*"))


CLUSTER_ALONE = """
import sys, time
from pathlib import Path
from tests.studio.night.torture import workers
workers.COUNT = 1
workers.Workers(Path(sys.argv[1]))
print("there", flush=True)
time.sleep(600)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere nothing tells a process that its parent was killed")
@pytest.mark.slow
def test_a_cluster_ends_with_the_torture_that_is_killed(tmp_path: Path) -> None:
    """A scheduler and three workers stayed for minutes, beside what was done next."""
    command = [sys.executable, "-c", CLUSTER_ALONE, str(tmp_path)]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, preexec_fn=ends_with_us) as torture:
        assert torture.stdout is not None
        assert torture.stdout.readline() == b"there\n"
        family = psutil.Process(torture.pid).children(recursive=True)
        torture.kill()
    _, left = psutil.wait_procs(family, timeout=40.0)
    subprocess.run(["umount", "-l", str(tmp_path / "w0")], capture_output=True, check=False)
    for process in left:
        process.kill()
    assert len(family) >= 4, "a scheduler, who keeps the worker, its nanny and the worker itself"
    assert not left


@pytest.mark.parametrize("field", ["wrong", "lost", "redone", "refused", "hangs", "orphans", "tracebacks"])
def test_each_count_makes_a_round_bad(field: str) -> None:
    assert not Outcome(fault="x", target="run-all", state="half", moment=1.0).bad
    assert Outcome(fault="x", target="run-all", state="half", moment=1.0, **{field: 1}).bad


@pytest.mark.parametrize("who", ["", "pendulum: ", "2026-11-27 06:14:49 ", "2026-11-27 06:14:49 pendulum: "])
def test_tracebacks_are_seen_in_the_log_of_a_night_but_for_a_ctrl_c(who: str) -> None:
    said = f"a line\n{who}Traceback (most recent call last):\n{who}  File x\n{who}    code\n{who}%s\n{who}more\n"
    assert len(re.findall(TRACEBACK, said % "RuntimeError: ConnectionPool is closed", re.MULTILINE)) == 1
    assert not re.findall(TRACEBACK, said % "KeyboardInterrupt", re.MULTILINE)


def test_damages_change_the_bytes() -> None:
    content = bytes(range(32, 127)) * 3
    for seed in range(200):
        assert flipped(content, random.Random(seed)) != content
        assert len(flipped(content, random.Random(seed))) == len(content)
        assert max(no_text(content, random.Random(seed))) > 0x7F
        assert content.startswith(cut(content, random.Random(seed)))
    for damage in (cut, flipped, no_text):
        assert damage(b"", random.Random(1)) in (b"", b"\x00") or damage is no_text


def test_faults_have_names_of_their_own() -> None:
    always = [*FAULTS, *CLUSTER]
    assert len({fault.name for fault in always}) == len(always)
    assert not {fault.name for fault in always} & {f.name for f in (*FULL, *DISK_OF_ONE, *BACKGROUND, *FETCH)}
    assert all(fault.cluster and fault.undo for fault in (*CLUSTER, *DISK_OF_ONE))
