"""A real night at the size of a postage stamp, killed, stopped and finished: no picture is lost or made twice."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from shared.contract.shot import Shot
from shared.stage.paths import ROOT
from tests.running.processes import until, working_for
from tools.fixtures import film_fixture

PICTURES = 60


@pytest.fixture
def command(out_root: Path, tmp_path: Path) -> list[str]:
    """Return the command of a night over a film of 24 pictures with motion, parts and shot."""
    film_fixture.write(Shot(turns=1, seconds_per_turn=PICTURES / 30))
    script = tmp_path / "python"
    script.write_text(
        f"#!/bin/sh\nPYTHONPATH='{ROOT}' exec '{sys.executable}' '{ROOT}/tests/studio/night/stamped.py' \"$@\"\n"
    )
    script.chmod(0o755)
    return [str(script), "-m", "studio.night", "run", "--preset=draft", "--only=four_bar", f"--python={script}"]


def pictures(out: Path) -> dict[str, int]:
    """Return the existing pictures with the times at which they were written."""
    folder = out / "four_bar" / "frames" / "draft"
    return {path.name: path.stat().st_mtime_ns for path in folder.glob("[!.]*.png")}


def test_a_film_that_is_killed_and_stopped_has_every_picture_once(command: list[str], out_root: Path):
    def start() -> subprocess.Popen[str]:
        return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def say(word: str) -> str:
        words = [sys.executable, "-m", "studio.night", word]
        return subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True).stdout

    run = start()
    until(lambda: len(pictures(out_root)) >= 4, 120)
    os.kill(run.pid, signal.SIGKILL)
    run.communicate(timeout=60)
    until(lambda: not working_for(out_root))
    killed = pictures(out_root)

    run = start()
    until(lambda: len(pictures(out_root)) >= min(len(killed) + 3, PICTURES), 120)
    word = say("stop")
    assert "run 1 has ended after" in word or len(pictures(out_root)) == PICTURES
    said, _ = run.communicate(timeout=60)
    assert run.returncode in (130, 0), said  # 0 where the last picture was there before the word to stop
    stopped = pictures(out_root)
    assert stopped.items() >= killed.items()
    if run.returncode:
        assert f"{len(stopped)}/{PICTURES}" in say("status")

    run = start()
    said, _ = run.communicate(timeout=120)
    assert run.returncode == 0, said
    done = pictures(out_root)
    assert done.items() >= stopped.items()
    assert len({name.partition("-")[0] for name in done}) == len(done) == PICTURES
    assert (out_root / "films" / "four_bar-draft.mp4").is_file()
    assert f"{PICTURES}/{PICTURES}" in say("status")
    assert not working_for(out_root)
    assert not list(out_root.glob(".blender/tmp-*"))
