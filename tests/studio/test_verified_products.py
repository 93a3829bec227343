"""Plates, outlines, lists and exports are made again and compared; what is damaged or of older parts is found."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pytest

from mechanisms.stages.export import stage as export_stage
from mechanisms.stages.print import stage as print_stage
from shared.stage.paths import Out
from shared.stage.stages import Stage
from studio.verify import products
from tests.mechanisms.printed_pieces import Press


@pytest.fixture
def press(out_root: Path, monkeypatch: pytest.MonkeyPatch) -> Press:
    made = Press(monkeypatch)
    made.make()
    return made


def _again(out: Out, scratch: Path, monkeypatch: pytest.MonkeyPatch) -> products.Again:
    """Return a runner of stages with their results in scratch, where the parts are."""
    shutil.copytree(out.parts_folder, scratch / out.name / "parts")

    def again(_: str, stage: str, name: str, *options: str) -> None:
        said = dict(option.removeprefix("--").split("=") for option in options)
        with monkeypatch.context() as patch:
            patch.setenv("MBSD_OUT", str(scratch))
            if stage == "print":
                print_stage.run(name, **said)
            else:
                export_stage.run(name, said["format"], float(said["time"]))

    return again


def test_plates_and_lists_are_laid_out_again_as_they_were(
    press: Press, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out, scratch = press.out, tmp_path / "scratch"
    again = _again(out, scratch, monkeypatch)
    assert products.of_print(out, scratch / out.name, again) == [], "there are none"
    print_stage.run(out.name, bed="130x100", gap="4")
    (finding,) = products.of_print(out, scratch / out.name, again)
    assert re.fullmatch(r"print \(3MF, STL, DXF, lists\): same, \d+ files", str(finding))
    outline = next(iter(sorted(out.print_folder.glob("*.dxf"))))
    outline.write_bytes(outline.read_bytes().replace(b"LINE", b"LIME", 1))
    (finding,) = products.of_print(out, scratch / out.name, again)
    assert finding.verdict == "differs"
    assert f"1 of {len(list(out.print_folder.iterdir()))} files, such as {outline.name} from byte" in finding.detail
    out.parts.write_bytes(out.parts.read_bytes() + b"\n")
    (finding,) = products.of_print(out, scratch / out.name, again)
    assert str(finding).endswith("made from other inputs, parts.json changed since")


def test_plates_of_a_mechanism_that_has_changed_are_made_from_other_inputs(
    press: Press, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its parts are of the older mechanism too, so plates follow from parts.json as it stands."""
    out, scratch = press.out, tmp_path / "scratch"
    again = _again(out, scratch, monkeypatch)
    print_stage.run(out.name)
    rebuilt = scratch / out.name / "parts" / "parts.json"
    described = json.loads(rebuilt.read_bytes())
    described["provenance"]["inputs"] = "0" * 64
    rebuilt.write_text(json.dumps(described))
    (finding,) = products.of_print(out, scratch / out.name, again)
    assert finding.verdict == "outdated"


def test_plates_of_which_no_record_is_kept_are_not_compared(press: Press, tmp_path: Path) -> None:
    print_stage.run(press.out.name)
    Stage(press.out, "print", "", []).stamp.unlink()
    (finding,) = products.of_print(press.out, tmp_path, lambda *_: None)
    assert finding.verdict == "missing"


def test_exports_are_written_again_for_the_same_pose(
    out_root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out, scratch = Out("pendulum"), tmp_path / "scratch"
    out.parts_folder.mkdir(parents=True)
    again = _again(out, scratch, monkeypatch)
    export_stage.run("pendulum", "dxf", 0.3)
    export_stage.run("pendulum", "csv")
    findings = products.of_exports(out, scratch / "pendulum", again)
    assert [finding.verdict for finding in findings] == ["same", "same"], findings
    table = export_stage.file_of(out, "csv")
    table.write_bytes(table.read_bytes().replace(b"0", b"1", 1))
    assert [finding.verdict for finding in products.of_exports(out, scratch / "pendulum", again)] == ["differs", "same"]
    Stage(out, "export-csv", "", []).stamp.unlink()
    assert [finding.verdict for finding in products.of_exports(out, scratch / "pendulum", again)] == ["missing", "same"]
    monkeypatch.setattr(export_stage, "SOURCES", [])
    assert [finding.verdict for finding in products.of_exports(out, scratch / "pendulum", again)] == [
        "missing", "outdated",
    ]  # fmt: skip
