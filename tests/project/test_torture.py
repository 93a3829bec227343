"""A few rounds of the torture; `make torture N=100` plays more."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from pathlib import Path

import pytest

from shared.stage.paths import ROOT
from tools.torture.damage import cut, flipped, no_text
from tools.torture.faults import BACKGROUND, CLUSTER, DISK_OF_ONE, FAULTS, FETCH, FULL
from tools.torture.rounds import Outcome


def test_two_rounds(out_root: Path, tmp_path: Path) -> None:
    """Faults at random moments lose nothing; the seed is fixed, so that it is the same test each day.

    Where a small disk can be mounted, one of the two rounds fills it, and the other has no memory.
    """
    done = subprocess.run(
        [sys.executable, "-m", "tools.torture", "--n", "2", "--seed", "15"],
        cwd=ROOT,
        env=os.environ | {"MBSD_OUT": str(out_root), "TMPDIR": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=400,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    report = json.loads((out_root / "torture.json").read_bytes())
    assert report["rounds"] == len(report["outcomes"]) == 2
    counts = ("wrong", "lost", "redone", "refused", "hangs", "orphans", "tracebacks", "leftovers")
    assert [report[name] for name in counts] == [0] * len(counts)
    assert report["twice"] <= report["hit"]  # the frame in flight
    listing = subprocess.run(["ps", "-axwwo", "args="], capture_output=True, text=True, check=True).stdout
    assert str(tmp_path) not in listing
    assert not list(tmp_path.glob("mbsd-torture-*"))


@pytest.mark.parametrize("field", ["wrong", "lost", "redone", "refused", "hangs", "orphans", "tracebacks"])
def test_each_count_makes_a_round_bad(field: str) -> None:
    assert not Outcome(fault="x", target="run-all", state="half", moment=1.0).bad
    assert Outcome(fault="x", target="run-all", state="half", moment=1.0, **{field: 1}).bad


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
