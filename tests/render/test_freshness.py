"""Reports and pages show the machine as it is now: their clearance, and results of other stages."""

from __future__ import annotations

import subprocess

import pytest

from render import freshness, report
from render.freshness import Freshness, clearance_files, current_clearance
from shared.contract import Provenance, read_motion, read_parts, write_motion
from shared.contract.clearance import Clearance, write_clearance
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of
from tools.fixtures import film_fixture

CLEARANCE = Clearance(
    mechanism="four_bar", provenance=Provenance(inputs="0" * 64, versions={}), limit=5e-5, resolution=5e-6,
    interpolation_error=0.0, pairs=[], apart=3,
)  # fmt: skip


@pytest.fixture
def out(out_root) -> Out:
    """A machine whose parts were proven not to touch."""
    out = film_fixture.write()
    write_clearance(out.clearance, CLEARANCE)
    Stage(out, "clearance", key_of(out.motion, out.parts), [out.clearance]).record()
    return out


def test_a_clearance_of_the_motion_before_is_no_proof(out: Out, capsys: pytest.CaptureFixture[str]) -> None:
    """The report of a machine that was solved again named the gaps of the one before."""
    parts = read_parts(out.parts)
    assert current_clearance(out, parts, "report") is not None
    assert clearance_files(out) == [out.clearance]
    report.run("four_bar")
    assert "It was not checked" not in out.report.read_text()
    motion = read_motion(out.motion)
    motion.provenance.inputs = "1" * 64
    write_motion(out.motion, motion)
    report.run("four_bar")
    assert "It was not checked: there is no clearance.json of this motion." in out.report.read_text()
    assert (
        "the clearance is of an older data.json, so it is left out; make clearance-four-bar" in capsys.readouterr().out
    )
    assert clearance_files(out) == []
    Stage(out, "clearance", key_of(out.motion, out.parts), [out.clearance]).record()
    report.run("four_bar")
    assert "It was not checked" not in out.report.read_text(), "it is written again once the proof is there"


def test_why_a_file_is_of_an_older_version(out: Out, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(freshness, "current_names", set)
    asked = Freshness(["four_bar"])
    assert asked.why_older(out, out.glb) == "it is not there"
    out.glb.write_bytes(b"glb")
    assert asked.why_older(out, out.glb) == "no stage has recorded what it was made of"
    Stage(out, "glb", key_of(out.motion, out.parts, out.shot), [out.glb]).record()
    assert asked.why_older(out, out.glb) == ""
    out.shot.write_bytes(out.shot.read_bytes() + b"\n")
    out.parts.write_bytes(out.parts.read_bytes() + b"\n")
    assert asked.why_older(out, out.glb) == "it is of an older parts.json and shot.json"
    out.glb.write_bytes(b"edited")
    assert asked.why_older(out, out.glb) == "it is not as a stage left it"
    monkeypatch.setattr(freshness, "current_names", lambda names: set())
    assert Freshness(["four_bar"]).why_older(out, out.glb) == "the machine has changed since it was solved"


def test_who_is_not_known_to_be_current_counts_as_older(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def hangs(*words: object, **more: object) -> None:
        raise subprocess.TimeoutExpired("python", 1.0)

    assert freshness.current_names([]) == set()
    monkeypatch.setattr(subprocess, "run", hangs)
    assert freshness.current_names(["four_bar"]) == set()
    assert "so the others count as older: no answer within 300 s" in capsys.readouterr().err
