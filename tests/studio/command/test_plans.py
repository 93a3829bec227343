"""Plans of commands: the stages that run, and their lines for ``--plan``."""

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
from tests.studio.command.plans import STAGES, planned

# The stages that each command runs, in order, and the words that they get.


PICTURES = ("still", "poster", "contact", "frames", "film", "scene", "scene-ui")


@pytest.mark.parametrize(
    ("command", "stages"),
    [
        ("run", tuple("plot" if stage == "plots" else stage for stage in STAGES)),
        ("parts", ("parts",)),
        ("print", ("parts", "print")),
        ("solve", ("parts", "solve")),
        ("clearance", ("parts", "solve", "clearance")),
        ("plot", ("parts", "solve", "plot")),
        ("film", ("parts", "solve", "shot", "film")),
    ],
)
def test_each_command_runs_what_it_stands_on(command: str, stages: tuple[str, ...]) -> None:
    plan = planned(command, "four-bar")
    assert [line.split()[:2] for line in plan] == [[stage, "four_bar"] for stage in stages]
    assert planned(command, "four_bar") == plan


@pytest.mark.parametrize("command", PICTURES)
def test_picture_commands_take_preset_aspect_and_what_to_show(command: str) -> None:
    first = "still four_bar --frame 0" if command == "still" else f"{command} four_bar"
    usual = "draft" if command == "contact" else "preview"
    assert planned(command, "four-bar")[-1] == f"{first} --preset {usual}"
    [*_, full] = planned(command, "four-bar", PRESET="final", ASPECT="9:16", SHOW="reactions,title")
    assert full == f"{first} --preset final --aspect 9:16 --show reactions,title"


@pytest.mark.parametrize(
    ("command", "words", "last"),
    [
        ("still", {"FRAME": "15"}, "still four_bar --frame 15 --preset preview"),
        ("film", {"SOUND": "off"}, "film four_bar --preset preview --sound off"),
        ("frames", {"SOUND": "off"}, "frames four_bar --preset preview"),
        ("film", {"SCALE": "1:2"}, "film four_bar --preset preview"),
        ("print", {"BED": "180x180"}, "print four_bar --bed 180x180"),
        ("parts", {"SCALE": "1:2", "ANYWAY": "1"}, "parts four_bar --scale 1:2 --anyway 1"),
        ("clearance", {"SCALE": "1:2"}, "clearance four_bar --scale 1:2"),
        ("animate", {"VIEW": "reactions,velocities"}, "animate four_bar --view reactions,velocities"),
        ("plot", {"SPECTRA": "shaking force,motor"}, "plot four_bar --spectra 'shaking force,motor'"),
    ],
)
def test_a_command_passes_its_own_words_on_and_no_others(command: str, words: dict[str, str], last: str) -> None:
    assert planned(command, "four-bar", **words)[-1] == last


def test_a_run_passes_words_to_the_stages_that_take_them() -> None:
    plan = planned("run", "four-bar", SOUND="off", SPECTRA="motor", ASPECT="1:1")
    taken = {line.split()[0]: line.split()[2:] for line in plan}
    assert [stage for stage, words in taken.items() if "--spectra" in words] == ["plot"]
    assert [stage for stage, words in taken.items() if "--sound" in words] == ["film"]
    assert [stage for stage, words in taken.items() if "--aspect" in words] == ["poster", "film"]


def test_a_model_at_a_scale_is_printed_with_a_proof_of_its_own() -> None:
    plan = planned("print", "four-bar", SCALE="1:2", BED="180x180")
    assert [line.split()[0] for line in plan] == ["parts", "parts", "print", "solve", "clearance"]
    assert [line.endswith("--scale 1:2") for line in plan] == [False, True, True, False, True]


def test_compare_solves_a_mechanism_and_each_of_its_variants() -> None:
    assert planned("compare", "belt-drive", SPECTRA="motor") == [
        "parts belt_drive", "solve belt_drive",
        "parts belt_drive-crossed", "solve belt_drive-crossed",
        "parts belt_drive-chain", "solve belt_drive-chain",
        "compare belt_drive --spectra motor",
    ]  # fmt: skip


# The lines of ``--plan``: words that a user can type, and what is made, for every command.


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
        if typed.split()[0] not in ("shot", "designs"):  # no commands of their own
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
