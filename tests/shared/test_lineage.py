"""Stages end with the make that started them, whatever ends it."""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from shared.stage.paths import ROOT
from shared.stage.signals import PERIOD, is_ending
from tests.running.processes import command_lines, until, working_for

STAGE = """
import sys, time
from pathlib import Path
from shared.stage.console import run_cli

def main():
    left = Path(sys.argv[1])
    try:
        left.touch()
        time.sleep(60)
    finally:
        left.unlink()

run_cli(main)
"""
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="nothing tells there that make got this signal")


@pytest.mark.parametrize(
    ("victim", "how"),
    [
        ("make", signal.SIGTERM),
        pytest.param("make", signal.SIGINT, marks=LINUX),
        pytest.param("make", signal.SIGHUP, marks=LINUX),
        ("make", signal.SIGKILL),
        ("the night", signal.SIGTERM),
        ("the night", signal.SIGINT),
        ("the night", signal.SIGKILL),
    ],
    ids=str,
)
def test_whatever_ends_run_all_ends_its_stages(tmp_path: Path, victim: str, how: signal.Signals) -> None:
    left, script = tmp_path / "left behind", tmp_path / "python"
    (tmp_path / "stage.py").write_text(STAGE)
    script.write_text(
        f"#!/bin/sh\ncase $2 in studio.*) exec '{sys.executable}' \"$@\" ;; esac\n"
        f"exec '{sys.executable}' '{tmp_path}/stage.py' '{left}'\n"
    )
    script.chmod(0o755)
    clean = {key: value for key, value in os.environ.items() if key not in ("MAKEFLAGS", "MAKELEVEL", "MBSD_MAKE")}
    process = subprocess.Popen(
        ["make", "-o", "install", "run-all", "ONLY=four_bar", f"PYTHON={script}"],
        cwd=ROOT,
        env=clean | {"PYTHONPATH": str(ROOT), "MBSD_OUT": str(tmp_path / "out")},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        until(left.exists)
        said = f"{sys.executable} -m studio.night run"  # the shell above it has these words, too
        nights = [pid for pid, words in command_lines().items() if words.startswith(said) and str(script) in words]
        os.kill(process.pid if victim == "make" else nights[0], how)
        process.wait(timeout=20)
        until(lambda: not working_for(left))
        assert not left.exists()
    finally:
        for pid in working_for(tmp_path):
            os.kill(pid, signal.SIGKILL)


def test_a_command_outlives_the_shell_that_started_it(tmp_path: Path) -> None:
    """``nohup mbsd film x &``: the stage takes the place of the program, which is the outermost of its lineage."""
    left = tmp_path / "left behind"
    (tmp_path / "stage.py").write_text(STAGE)
    program = f"export MBSD_MAKE=$$; exec '{sys.executable}' '{tmp_path}/stage.py' '{left}'"
    command = f"nohup sh -c {shlex.quote(program)} > '{tmp_path}/log' 2>&1 &"
    subprocess.run(["sh", "-c", command], env=os.environ | {"PYTHONPATH": str(ROOT)}, check=True)
    try:
        until(left.exists)
        time.sleep(3 * PERIOD)
        [process] = working_for(left)
        assert left.exists(), (tmp_path / "log").read_text()
        os.kill(process, signal.SIGTERM)
        until(lambda: not left.exists())
    finally:
        for pid in working_for(tmp_path):
            os.kill(pid, signal.SIGKILL)


def test_a_stage_that_ends_with_its_command_says_why(tmp_path: Path) -> None:
    left = tmp_path / "left behind"
    (tmp_path / "stage.py").write_text(STAGE)
    with subprocess.Popen(["sleep", "60"]) as command:
        stage = subprocess.Popen(
            [sys.executable, str(tmp_path / "stage.py"), str(left)],
            env=os.environ | {"PYTHONPATH": str(ROOT), "MBSD_MAKE": str(command.pid)},
            stderr=subprocess.PIPE,
            text=True,
        )
        until(left.exists)
        command.kill()
    _, said = stage.communicate(timeout=20)
    assert stage.returncode == 128 + signal.SIGTERM
    assert "error: stopped, because the command that started this stage has ended; what is finished is kept" in said
    assert not left.exists()


@LINUX
@pytest.mark.parametrize(("blocked", "ending"), [("valid_signals()", False), ("{SIGQUIT}", True), ("{SIGTERM}", True)])
def test_a_process_that_starts_another_is_not_ending(blocked: str, ending: bool) -> None:
    """posix_spawn and vfork block all signals until the other one runs; make blocks the fatal one alone."""
    plain = "signal(SIGQUIT, SIG_DFL)"  # a shell's background jobs ignore it
    code = f"from signal import *; {plain}; pthread_sigmask(SIG_BLOCK, {blocked}); print(flush=True); input()"
    with subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        child.stdout.readline()
        assert is_ending(child.pid) == ending
        child.kill()
