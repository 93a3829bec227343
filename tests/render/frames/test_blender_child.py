"""The process that runs Blender: it never waits for ever, never in silence, and says how Blender ended."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest

from render.blender import child
from render.blender.job import Job, Picture
from render.blender.process import FLOOR, START, Patience
from render.film.scene import Scene, StudioSpec
from render.looks import LOOKS
from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from tests.running.processes import working_for

STUDIO = StudioSpec(look=LOOKS["studio"], centre=(0.0, 0.0, 0.0), radius=1.0, floor=0.0, azimuth=0.0)
SCENE = Scene(mechanism="x", fps=30, pieces=[], trails=[], labels=[], studio=STUDIO)


@pytest.fixture
def acts(out_root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Runs a worker that acts as told, with two seconds of patience for a picture; keys of the pictures it made."""
    monkeypatch.setattr(child, "WORKER", "tests.render.frames.acting_worker")
    monkeypatch.setattr(child, "TICK", 0.1)
    monkeypatch.setattr(child, "FIRST_WORD", 0.5)
    monkeypatch.setenv("MBSD_PATIENCE", "2")

    def run(*names: str) -> list[str]:
        pictures = [Picture(state=0, folder=str(tmp_path), key=f"k{i}", name=name) for i, name in enumerate(names)]
        with child.blender(Job(scene=SCENE, states=[], pictures=pictures)) as answers:
            return [answer.key for answer in answers if answer.key]

    yield run
    assert not list(out_root.glob(".blender/tmp-*"))
    assert not working_for(out_root)


def test_a_worker_that_hangs_is_started_again_with_what_is_left(acts, capsys: pytest.CaptureFixture[str]):
    assert acts("good", "stops once", "good") == ["k0", "k1", "k2"]
    said = capsys.readouterr().err
    assert (
        "warning: Blender has said nothing for 0.5 s (renders stops once: Sample 1/8, stopped by a signal: kill" in said
    )
    assert "; it is started again after 2.0 s" in said
    assert "lets it go on); it is started again\n" in said


def test_each_picture_may_hang_once(acts):
    assert acts("stops once", "good", "stops once") == ["k0", "k1", "k2"]


def test_a_worker_that_hangs_twice_is_an_error_with_what_it_did_last(acts):
    started = time.monotonic()
    sentence = (
        r"Blender has said nothing for .* s \(renders sleeps: Sample 1/8.*\), for the second time; nothing was lost"
    )
    with pytest.raises(UserError, match=sentence):
        acts("good", "sleeps", "good")
    assert time.monotonic() - started < 30


def test_a_worker_that_hangs_on_its_way_out_has_done_its_job(acts):
    assert acts("good", "does not end") == ["k0", "k1"]


@pytest.mark.parametrize(
    ("act", "words"),
    [
        ("SIGKILL", r"Blender was killed by SIGKILL \(renders SIGKILL: .*\): by the system if the memory ran out"),
        (
            "SIGSEGV",
            r"crashed by SIGSEGV \(renders SIGSEGV: Sample 1/8\), for the second time; make check tells the dev",
        ),
        ("SIGTERM", "Blender was ended from outside by SIGTERM"),
        ("fails", r"Blender ended with code 1 \(renders fails: Sample 1/8\): RuntimeError: no such node"),
        ("is cut", "Blender was killed by SIGKILL"),
    ],
)
def test_how_it_ended_is_told_by_its_signal_and_not_by_a_warning_of_blenders(acts, act: str, words: str):
    with pytest.raises(UserError, match=words) as error:
        acts("good", act)
    assert "texture" not in str(error.value)


@pytest.mark.parametrize("act", ["SIGKILL", "SIGSEGV", "SIGABRT"])
def test_each_picture_may_crash_once(acts, act: str, capsys: pytest.CaptureFixture[str]):
    assert acts(f"{act} once", "good", f"{act} once") == ["k0", "k1", "k2"]
    assert capsys.readouterr().err.count("; it is started again\n") == 2


def test_a_worker_that_grows_is_replaced_and_makes_what_is_left(acts, capsys: pytest.CaptureFixture[str]):
    names = ["good"] * 8
    names[6] = "grows"
    assert acts(*names) == [f"k{number}" for number in range(8)]
    said = capsys.readouterr().out
    assert re.search(
        r"Blender takes \d{3,} MB of memory after 7 pictures, \d+ MB after 5; it is replaced by a new", said
    )
    assert "warning" not in said


def test_a_worker_that_grows_at_its_end_is_not_started_again(acts, capsys: pytest.CaptureFixture[str]):
    names = ["good"] * 7
    names[6] = "grows"
    assert acts(*names) == [f"k{number}" for number in range(7)]
    assert "replaced" not in capsys.readouterr().out


def test_memory_may_double_where_there_is_little_and_not_where_there_is_much():
    assert child.limit(100e6) > 2 * 100e6
    assert child.limit(5e9) < 2 * 5e9
    assert child.resident(2**22 + 1) == 0.0
    assert child.resident(os.getpid()) > 1e6


def test_patience_follows_what_a_picture_takes(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv("MBSD_PATIENCE", raising=False)
    patience = Patience()
    assert patience.limit("builds the scene") == START
    assert patience.limit("renders frame 1: Loading render kernels (may take a few minutes the first time)") > 5 * START
    patience.finished(0.2)
    assert patience.limit("renders frame 2: Sample 1/8") == FLOOR
    patience.finished(831.0)
    assert patience.limit("renders frame 3: Sample 1/64") == pytest.approx(8310.0)
    assert Patience(1e9).limit("") < 86400
    monkeypatch.setenv("MBSD_PATIENCE", "12")
    assert Patience().limit("") == pytest.approx(START / 10)
    for nonsense in ("x", "", "0", "-1", "inf", "nan"):
        monkeypatch.setenv("MBSD_PATIENCE", nonsense)
        assert Patience().limit("") == START


def test_a_worker_does_not_outlive_a_killed_parent(out_root: Path, tmp_path: Path):
    code = (
        "import sys; from tests.render.frames.test_blender_child import SCENE; from render.blender import child\n"
        "from render.blender.job import Job\n"
        "with child.blender(Job(scene=SCENE, states=[], blend=sys.argv[1])) as answers:\n"
        "    print(child.os.getpid(), flush=True); next(answers); sys.stdin.read()\n"
    )
    parent = subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path / "a.blend")], cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert parent.stdin
    assert parent.stdout
    parent.stdout.readline()
    end = time.monotonic() + 30
    while not (workers := working_for(out_root)):
        assert time.monotonic() < end
        time.sleep(0.02)
    parent.kill()
    parent.communicate()
    while working_for(out_root):
        assert time.monotonic() < end, workers
        time.sleep(0.02)
