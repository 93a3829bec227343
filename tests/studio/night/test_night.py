"""Whole nights with stand-ins for the stages: order, failures, crashes, hangs, kills, two at once, stop and status."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from render.presets import PRESETS, preset_named
from shared.stage.errors import UserError
from studio.night.plan.options import Options, options
from studio.night.plan.steps import STEPS, command
from tests.running.processes import until, working_for
from tests.studio.command.plans import STAGES, planned
from tests.studio.night.nights import Night, finished


@pytest.fixture
def night(tmp_path: Path) -> Night:
    return Night(tmp_path / "night")


def alive(night: Night) -> list[str]:
    """Return the processes of stand-ins that are left."""
    return [line for line in working_for(night.folder).values() if "stand_in.py" in line]


def test_a_failure_stops_no_other_and_table_and_exit_code_tell_it(night: Night):
    night.tell("four_bar", "clearance", "fail")
    code, out, err = finished(night.start("four-bar,slider_crank"))
    assert code == 1
    ran = night.ran()
    assert {line.split()[1] for line in ran if line.startswith("slider_crank ")} == set(STAGES)
    assert {line.split()[1] for line in ran if line.startswith("four_bar ")} == set(STAGES) - {"report", "film"}
    assert len(ran) == len(set(ran))
    table = out[out.index("TABLE") :].splitlines()
    assert [line.split()[::2] for line in table[1:3]] == [["four_bar", "failed"], ["slider_crank", "done"]]
    assert "four_bar: clearance failed: four_bar has a bad link; make it longer" in err
    assert "1 done, failed: four_bar" in err
    status = night.say("status")
    assert "over, with failures" in status
    assert "four_bar: clearance: four_bar has a bad link; make it longer" in status


def test_options_reach_the_stages(night: Night):
    code, out, _ = finished(
        night.start("four_bar", "--show=forces,title", "--sound=off", "--spectra=shaking force", "--watts=85")
    )
    assert code == 0
    assert "plots: four_bar: --spectra=shaking force --every" in out
    assert "film: four_bar: --preset draft --show=forces,title --sound=off" in out
    log = (night.folder / "out" / "night" / "log.txt").read_text()
    assert "film: four_bar: done" in log
    assert "night: 1 done" in log


def test_steps_and_commands_are_those_of_run_in_the_makefile():
    asked = Options(names=("four_bar",), preset=PRESETS["draft"], show="title", spectra="motor", python="echo")
    lines = planned("run", "four-bar", PRESET="draft", SHOW="title", SPECTRA="motor")
    assert [step.name for step in STEPS] == list(STAGES)
    commands = [" ".join(command(step.name, "four_bar", asked)[3:]).replace("=", " ") for step in STEPS]
    assert [line.endswith(" --every") for line in commands] == [line.startswith("plots") for line in commands]
    commands = [line.replace("plots", "plot").removesuffix(" --every") for line in commands]
    assert [line.replace(" --or-warn", "") for line in commands] == lines


def test_an_aspect_is_asked_of_the_stages_by_the_name_of_its_preset():
    asked = options("four_bar", "draft", "", "", "", "echo", "", "9:16")
    assert asked.preset == PRESETS["draft"].framed("9:16")
    for step in ("poster", "film"):
        words = command(step, "four_bar", asked)
        assert preset_named(words[words.index("--preset") + 1]) == asked.preset
    with pytest.raises(UserError, match="there is no ASPECT=3:2; there is: 16:9, 1:1, 4:5, 9:16"):
        options("", "draft", "", "", "", "", "", "3:2")


def test_a_film_that_another_process_renders_is_waited_for(night: Night):
    night.tell("four_bar", "film", "once busy")
    code, out, _ = finished(night.start("four_bar", hurried=True))
    assert code == 0
    assert night.ran().count("four_bar film") == 2
    assert "four_bar: another process renders it; it waits for that" in out


@pytest.mark.parametrize("how", ["crash", "killed"])
def test_crashed_steps_are_started_once_more(night: Night, how: str):
    night.tell("four_bar", "film", f"once {how}")
    night.tell("slider_crank", "film", how)
    code, _, err = finished(night.start("four_bar,slider_crank"))
    assert code == 1
    assert night.ran().count("four_bar film") == night.ran().count("slider_crank film") == 2
    assert "1 done, failed: slider_crank" in err
    assert f"it was killed by {'SIGSEGV' if how == 'crash' else 'SIGKILL'}" in err


def test_hanging_steps_are_killed_and_started_once_more(night: Night):
    night.tell("four_bar", "plots", "once hang")
    code, _, err = finished(night.start("four_bar", hurried=True, MBSD_PATIENCE="0.05"))
    assert code == 0, err
    assert night.ran().count("four_bar plots") == 2
    assert "plots was silent for" in err


@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGKILL], ids=str)
def test_whatever_ends_a_night_ends_its_stages_and_status_tells(night: Night, how: signal.Signals):
    night.tell("four_bar", "film", "sleep 300")
    run = night.start("four_bar")
    until(lambda: "four_bar film" in night.ran())
    assert alive(night)
    assert "at work as process" in night.say("status")
    os.kill(run.pid, how)
    code, _, _ = finished(run)
    assert code == (-how if how == signal.SIGKILL else 128 + how)
    until(lambda: not alive(night))
    assert ("killed, or the machine" if how == signal.SIGKILL else "stopped; the same") in night.say("status")


def test_the_same_command_goes_on_after_a_kill(night: Night):
    night.tell("four_bar", "film", "sleep 300")
    run = night.start("four_bar")
    until(lambda: "four_bar film" in night.ran())
    run.kill()
    finished(run)
    night.tell("four_bar", "film", "")
    assert finished(night.start("four_bar"))[0] == 0  # the locks went with the process, the record stands for nothing
    assert night.say("status").startswith("done, last seen")


def test_a_second_run_takes_what_the_first_is_not_at_and_waits_for_the_rest(night: Night):
    night.tell("four_bar", "film", f"wait {night.folder}/go")
    first = night.start("four_bar")
    until(lambda: "four_bar film" in night.ran())
    second = night.start("four_bar,slider_crank")
    until(lambda: "slider_crank film" in night.ran())  # though no probe of the other was made in this run
    status = night.say("status")
    assert "(run 1, draft" in status
    assert "(run 2, draft" in status
    (night.folder / "go").touch()
    code, out, err = finished(second)
    assert (code, finished(first)[0]) == (0, 0), err
    assert f"four_bar: another run is at it (process {first.pid} on" in out


def test_stop_ends_what_is_beside_the_render_and_says_when_it_has(night: Night):
    night.tell("four_bar", "clearance", "sleep 300")
    run = night.start("four_bar")
    until(lambda: "four_bar clearance" in night.ran() and "four_bar poster" in night.ran())
    said = night.say("stop")
    assert "run 1 has ended after" in said
    code, out, _ = finished(run)
    assert code == 130
    assert "0 done, 1 not finished; the same command goes on" in out
    assert not alive(night)
    assert night.say("stop") == "stop: no night is at work here\n"


def test_words_that_cannot_be_are_refused_in_a_sentence(night: Night):
    for words, told in (
        (("four_bra",), "did you mean 'four_bar'?"),
        (("four_bar", "--watts=0"), "WATTS=0 is not a power"),
        (("four_bar", "--watts=much"), "WATTS=much is not a power"),
    ):
        code, _, err = finished(night.start(*words))
        assert code == 1
        assert told in err
    assert night.say("status").startswith("No night was started here yet")


def test_parts_that_a_cluster_makes_take_no_core_here(night: Night):
    names = ("four_bar", "slider_crank", "pendulum")
    for name in names:
        night.tell(name, "parts", f"wait {night.folder}/go")
    run = night.start(",".join(names), CLUSTER="tcp://127.0.0.1:1", PYTHON_CPU_COUNT="1")
    until(lambda: len(night.ran()) == len(names))  # though none has ended
    assert set(night.ran()) == {f"{name} parts" for name in names}
    (night.folder / "go").touch()
    assert finished(run)[0] == 0
