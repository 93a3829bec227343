"""A stage is redone for a changed input or a damaged output, and for nothing else."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from shared.stage import stages
from shared.stage.errors import UserError
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of, outdated_by, versions


@pytest.fixture
def out(out_root: Path) -> Out:
    return Out("four-bar")


def finish_stage(out: Out, key: str = "k") -> Stage:
    """Return a finished stage with two outputs, one outside the mechanism's folder."""
    stage = Stage(out, "film", key, [out.motion, out.film("draft")])
    for path in stage.outputs:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b"content")
    stage.record(frames=3)
    return stage


def test_fresh_after_done_and_not_before(out: Out) -> None:
    assert not Stage(out, "film", "k", [out.motion]).is_fresh()
    assert finish_stage(out).is_fresh()
    assert Stage(out, "film", "k", [out.motion, out.film("draft")]).is_fresh()


def test_another_key_or_another_output_is_not_fresh(out: Out) -> None:
    finish_stage(out)
    assert not Stage(out, "film", "other", [out.motion, out.film("draft")]).is_fresh()
    assert not Stage(out, "film", "k", [out.motion, out.film("draft"), out.poster]).is_fresh()


def test_a_touched_output_stays_fresh(out: Out) -> None:
    stage = finish_stage(out)
    os.utime(out.motion, (1, 1))
    assert stage.is_fresh()


@pytest.mark.parametrize(
    "damage",
    [
        lambda path: path.unlink(),
        lambda path: path.write_bytes(b"conten"),
        lambda path: path.write_bytes(b"CONTENT"),  # the same size
        lambda path: (path.unlink(), path.mkdir()),
    ],
    ids=["deleted", "cut short", "edited", "a folder instead"],
)
@pytest.mark.parametrize("which", ["motion", "film"])
def test_a_damaged_output_is_noticed(out: Out, damage: Callable[[Path], object], which: str) -> None:
    stage = finish_stage(out)
    damage(out.motion if which == "motion" else out.film("draft"))
    assert not stage.is_fresh()


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b'{"schema": "mbsd.stamp", "schema_version": 2}', b"\xff\xfe"])
def test_a_damaged_stamp_means_again(out: Out, content: bytes) -> None:
    stage = finish_stage(out)
    stage.stamp.write_bytes(content)
    assert not stage.is_fresh()
    assert stage.notes() == {}
    stage.record()
    assert stage.is_fresh()


def test_a_byte_above_0x7f_anywhere_in_a_stamp_means_again(out: Out) -> None:
    stage = finish_stage(out)
    content = stage.stamp.read_bytes()
    for place in range(len(content)):
        stage.stamp.write_bytes(content[:place] + b"\xff" + content[place + 1 :])
        assert not stage.is_fresh(), place
        assert stage.notes() == {}


def test_a_stamp_of_brackets_means_again(out: Out) -> None:
    stage = finish_stage(out)
    stage.stamp.write_bytes(stage.stamp.read_bytes().replace(b"3\n", b"[" * 100_000))
    assert not stage.is_fresh()


def test_an_output_that_cannot_be_read_is_not_whole(out: Out, monkeypatch: pytest.MonkeyPatch) -> None:
    stage = finish_stage(out)
    monkeypatch.setattr(stages, "file_hash", lambda _: Path("/dev/null/x").read_bytes())
    assert not stage.is_fresh()


def test_notes_are_kept(out: Out) -> None:
    assert Stage(out, "film", "k", []).notes() == {}
    finish_stage(out)
    assert Stage(out, "film", "other", []).notes() == {"frames": 3}


def test_done_without_the_output_is_an_error_that_names_it(out: Out) -> None:
    with pytest.raises(UserError, match=r"four_bar: stage solve ended without writing .*data\.json"):
        Stage(out, "solve", "k", [out.motion]).record()
    assert not out.stamps.exists()


def test_the_stamp_holds_no_path_and_no_time_of_this_machine(out: Out, tmp_path: Path) -> None:
    stage = finish_stage(out)
    first = stage.stamp.read_bytes()
    stage.record(frames=3)
    assert stage.stamp.read_bytes() == first
    assert str(tmp_path).encode() not in first
    assert b"../films/four_bar-draft.mp4" in first


def test_a_key_follows_content(tmp_path: Path) -> None:
    file = tmp_path / "a.py"
    file.write_text("1")
    key = key_of(file, "x", 1)
    os.utime(file, (1, 1))
    assert key_of(file, "x", 1) == key
    assert len({key, key_of(file, "x", 2), key_of(file, "x1"), key_of(file, "x", "1"), key_of("x", file, 1)}) == 5
    file.write_text("2")
    assert key_of(file, "x", 1) != key


def test_versions_names_what_is_installed() -> None:
    import numpy

    assert versions("numpy") == {"numpy": numpy.__version__}


def _chain(out: Out) -> None:
    """Record a motion, a clearance made of it, and a report made of both."""
    out.folder.mkdir(parents=True, exist_ok=True)
    out.motion.write_text("motion")
    Stage(out, "solve", "k", [out.motion]).record()
    out.clearance.write_text("clearance")
    Stage(out, "clearance", key_of(out.motion), [out.clearance]).record()
    out.report.write_text("report")
    Stage(out, "report", key_of(key_of(out.motion, out.clearance), "words"), [out.report]).record()


def test_a_result_is_up_to_date_until_what_it_was_made_of_changes(out: Out) -> None:
    _chain(out)
    assert outdated_by(out, out.report) == []
    out.motion.write_text("another motion")
    assert outdated_by(out, out.report) == ["data.json"]
    out.motion.write_text("motion")
    assert outdated_by(out, out.report) == []


def test_a_result_is_as_old_as_the_oldest_result_that_it_was_made_of(out: Out) -> None:
    _chain(out)
    out.motion.write_text("another motion")
    Stage(out, "solve", "l", [out.motion]).record()
    Stage(out, "report", key_of(out.motion, out.clearance), [out.report]).record()
    assert outdated_by(out, out.report) == ["data.json"], "of the clearance, which is of the motion before"
    Stage(out, "clearance", key_of(out.motion), [out.clearance]).record()
    assert outdated_by(out, out.report) == []
    out.motion.write_text("edited")
    Stage(out, "report", key_of(out.motion), [out.report]).record()
    assert outdated_by(out, out.report) == ["data.json"], "which is not as it was solved"


@pytest.mark.parametrize(
    "change", [lambda path: path.write_text("edited"), lambda path: path.unlink()], ids=["edited", "deleted"]
)
def test_a_result_that_is_not_as_its_stage_left_it_is_not_up_to_date(
    out: Out, change: Callable[[Path], object]
) -> None:
    _chain(out)
    change(out.report)
    assert outdated_by(out, out.report) == ["report.md"]


def test_a_file_that_no_stage_recorded_is_not_up_to_date(out: Out) -> None:
    _chain(out)
    out.poster.write_text("poster")
    assert outdated_by(out, out.poster) == ["poster.png"]


def test_a_stamp_that_does_not_say_what_it_was_made_of_is_written_again(out: Out) -> None:
    """Stamps of earlier versions do not."""
    _chain(out)
    key = key_of(key_of(out.motion, out.clearance), "words")
    assert Stage(out, "report", key, [out.report]).is_fresh()
    assert not Stage(out, "report", str(key), [out.report]).is_fresh()


def test_files_of_the_program_are_no_results(out: Out, tmp_path: Path) -> None:
    outside = tmp_path / "source.py"
    outside.write_text("1")
    out.folder.mkdir(parents=True)
    out.motion.write_text("motion")
    assert list(key_of(outside, out.motion).results) == [out.motion]
