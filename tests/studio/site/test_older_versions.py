"""The site shows nothing of an older version of a machine beside its motion as it is now."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from PIL import Image

from render import freshness, glb, report
from render.frames import encode
from render.presets import Preset
from shared.contract import read_motion, write_motion
from shared.stage.errors import UserError
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of
from studio import pages as view_pages
from studio.site import build
from tools.fixtures import film_fixture

NAME = "four_bar"
ALL = {"mechanism.py", "data.json", f"{NAME}.glb", "report.md", f"{NAME}_stl.zip", f"{NAME}_3mf.zip"}


def _film(path: Path, red: int) -> Path:
    buffer = io.BytesIO()
    Image.new("RGB", (64, 64), (red, 40, 70)).save(buffer, format="PNG")
    path.parent.mkdir(parents=True, exist_ok=True)
    encode.encode([buffer.getvalue()] * 15, 15, Preset("tiny", 64, 64, 1), 30, path)
    return path


def _stamped(out: Out, name: str, path: Path, *read: Path) -> None:
    Stage(out, name, key_of(*read), [path]).record()


@pytest.fixture
def out(out_root: Path, monkeypatch: pytest.MonkeyPatch) -> Out:
    """Return a mechanism with all its results, whose pages are built by others."""
    out = film_fixture.write()
    for name, path in (("solve", out.motion), ("shot", out.shot)):
        _stamped(out, name, path)
    Stage(out, "parts", "k", [out.parts, *out.parts_folder.glob("*.stl")]).record()
    report.run(NAME)
    glb.run(NAME)
    _stamped(out, "film-draft", _film(out.film("draft"), 200), out.motion, out.parts, out.shot)
    out.poster.write_bytes((Path(__file__).parents[3] / "docs" / "gallery" / "strip.jpg").read_bytes())
    _stamped(out, "poster", out.poster, out.motion, out.parts, out.shot)
    out.print_folder.mkdir()
    plate = out.print_folder / "plate_1.3mf"
    plate.write_bytes(b"plate")
    _stamped(out, "print", plate, out.parts)

    def pages(_: list[str]) -> int:
        out.view.write_bytes(out.motion.read_bytes())
        _stamped(out, "view", out.view, out.motion)
        return 0

    def page(_: str, target: Path) -> bool:
        target.write_bytes(b"page")
        return False

    monkeypatch.setattr(freshness, "current_names", set)
    monkeypatch.setattr(view_pages, "run", pages)
    monkeypatch.setattr(build, "write_machine_page", page)
    monkeypatch.setattr(build, "_skeleton", lambda out: _film(out.animation("skeleton", ".mp4"), 20))
    return out


def _files(out: Out) -> set[str]:
    return {path.name for path in (out.folder.parent / "site" / NAME / "files").iterdir()}


def _solved_again(out: Out) -> None:
    motion = read_motion(out.motion)
    motion.provenance.inputs = "1" * 64
    write_motion(out.motion, motion)
    _stamped(out, "solve", out.motion)


def test_files_of_an_older_motion_are_left_out_and_named_once(out: Out, capsys: pytest.CaptureFixture[str]) -> None:
    """Report, GLB, film and plates of the machine before were published without a word."""
    assert build.run([NAME]) == 0
    site = out.folder.parent / "site" / NAME
    assert not capsys.readouterr().err.count("outdated")
    assert _files(out) == ALL
    assert (site / "film.mp4").read_bytes() == out.film("draft").read_bytes()
    before = (site / "picture.jpg").read_bytes()
    _solved_again(out)
    assert build.run([NAME]) == 0
    (warning,) = [line for line in capsys.readouterr().err.splitlines() if "outdated" in line]
    for file in ("report.md", f"{NAME}.glb", f"{NAME}-draft.mp4", "poster.png"):
        assert f"{file} (it is of an older data.json)" in warning
    assert "plate" not in warning
    assert _files(out) == ALL - {"report.md", f"{NAME}.glb"}
    assert not (site / "film.mp4").exists()
    assert "<video" not in (site / "index.html").read_text()
    assert (site / "picture.jpg").read_bytes() != before
    report.run(NAME)
    glb.run(NAME)
    assert build.run([NAME]) == 0
    assert _files(out) == ALL


def test_plates_of_other_parts_are_left_out(out: Out, capsys: pytest.CaptureFixture[str]) -> None:
    out.parts.write_bytes(out.parts.read_bytes() + b"\n")
    Stage(out, "parts", "l", [out.parts, *out.parts_folder.glob("*.stl")]).record()
    build.run([NAME])
    assert "plate_1.3mf (it is of an older parts.json)" in capsys.readouterr().err
    assert _files(out) == {"mechanism.py", "data.json", f"{NAME}_stl.zip"}


def test_a_machine_whose_files_have_changed_since_is_left_out(
    out: Out, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(freshness, "current_names", lambda names: set())
    with pytest.raises(UserError, match="no machine has a motion to show"):
        build.run([NAME])
    assert "its page is outdated: the machine has changed since it was solved" in capsys.readouterr().err


def test_archives_have_the_same_bytes_each_time(out: Out) -> None:
    build.run([NAME])
    archive = out.folder.parent / "site" / NAME / "files" / f"{NAME}_stl.zip"
    before = archive.read_bytes()
    for path in out.parts_folder.glob("*.stl"):
        path.touch()
    archive.unlink()
    build.run([NAME])
    assert archive.read_bytes() == before
