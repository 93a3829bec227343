"""The lines of ``--plan``: words that a user can type, and what is made, for every command."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from shared.stage.paths import ROOT
from studio.command.main import parser
from studio.command.running import plan_line
from studio.command.stages import OPTIONS
from studio.command.table import COMMANDS

MODEL = """from dataclasses import dataclass
from mbsd import Mechanism, constant_rate

@dataclass(frozen=True)
class Params:
    crank: float = 0.03
    speed: float = 6.0

def build(p):
    m = Mechanism("lamp")
    crank = m.bar("crank", p.crank, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.drive_angle("motor", crank, constant_rate(p.speed))
    return m
"""


@pytest.mark.parametrize("name", COMMANDS)
def test_every_stage_has_words_and_no_word_of_the_inside(name: str) -> None:
    command = COMMANDS[name]
    said = {option: OPTIONS[option].default for option in command.options} | {"preset": "draft"}
    operand = "lamp" if command.of or name == "gallery" else ""  # which runs its stages for every mechanism
    for stage in command.stages:
        line = plan_line(stage.words(operand, said))
        typed, _, words = line.partition("  ")
        assert words.strip()
        assert not any(inside in line for inside in ("<name>", "<preset>", "--if-needed", "--or-none", "--python"))
        if typed.split()[0] != "shot":  # no command of its own
            parser().parse_args(typed.split())


def mbsd(*words: str, at: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-P", "-m", "mbsd", *words]
    return subprocess.run(command, cwd=at, env={"PATH": "", "PYTHONPATH": str(ROOT)}, capture_output=True, text=True)


def test_an_option_given_twice_is_joined_or_refused(tmp_path: Path) -> None:
    (tmp_path / "lamp.py").write_text(MODEL)
    planned = mbsd("study", "lamp", "--over", "crank=0.02,0.03", "--over", "speed=1,2", "--plan", at=tmp_path)
    assert planned.stdout.startswith("study lamp --over 'crank=0.02,0.03; speed=1,2'  "), planned.stderr
    refused = mbsd("film", "lamp", "--preset", "draft", "--preset", "final", "--plan", at=tmp_path)
    assert refused.returncode == 2
    assert "--preset takes one value, but was given draft and final" in refused.stderr
