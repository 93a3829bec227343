"""A new mechanism runs as it is written: it solves, its parts are sound, and no two of them touch."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from mechanisms.stages.new import new
from shared.stage.errors import UserError
from shared.stage.paths import MECHANISMS, ROOT


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the sources, so that the new folder does not land in ours."""
    folder = tmp_path_factory.mktemp("tree")
    for room in ("mbsd", "mechanisms", "render", "shared"):
        shutil.copytree(ROOT / room, folder / room, ignore=shutil.ignore_patterns("nbi_*", "*.pyc"))
    return folder


def stage(tree: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = {key: value for key, value in os.environ.items() if key not in ("MBSD_OUT", "NUMBA_CACHE_DIR")}
    return subprocess.run([sys.executable, "-m", *arguments], cwd=tree, capture_output=True, text=True, env=environment)


def test_a_new_mechanism_runs_whole_and_then_has_nothing_to_do(tree: Path) -> None:
    done = stage(tree, "mechanisms", "new", "my-linkage")
    assert done.returncode == 0, done.stderr
    assert "make run-my-linkage" in done.stdout
    assert sorted(p.name for p in (tree / "mechanisms" / "my_linkage").iterdir()) == [
        "mechanism.py",
        "parts.py",
        "shot.py",
    ]
    assert not list((tree / "mechanisms").glob(".new-*"))
    line = [("mechanisms", command, "my_linkage") for command in ("parts", "solve", "clearance", "shot")]
    line.append(("render", "plots", "my_linkage"))
    for command in line:
        done = stage(tree, *command)
        assert done.returncode == 0, (command, done.stderr)
    out = tree / "out" / "my_linkage"
    for result in ("data.json", "parts/parts.json", "parts/slider.stl", "clearance.json", "shot.json"):
        assert (out / result).is_file(), result
    assert {"path.png", "bodies.png", "slider-slider.png", "point-P.png"} <= {p.name for p in (out / "plots").iterdir()}
    before = {p: p.stat().st_mtime_ns for p in out.rglob("*") if p.is_file()}
    for command in line:
        done = stage(tree, *command)
        assert (done.returncode, done.stderr) == (0, ""), command
    assert before == {p: p.stat().st_mtime_ns for p in out.rglob("*") if p.is_file()}


def changed(tree: Path, edit: tuple[str, str, str]) -> set[str]:
    """Results that an edit (file, old text, new text) of my_linkage changes, when all its stages run again."""
    out = tree / "out" / "my_linkage"
    before = {p: p.stat().st_mtime_ns for p in out.rglob("*") if p.is_file()}
    file = tree / "mechanisms" / "my_linkage" / edit[0]
    text = file.read_text()
    assert edit[1] in text
    file.write_text(text.replace(edit[1], edit[2]))
    for command in ("parts", "solve", "clearance", "shot"):
        done = stage(tree, "mechanisms", command, "my_linkage")
        assert done.returncode == 0, (command, done.stderr)
    after = {p: p.stat().st_mtime_ns for p in out.rglob("*") if p.is_file() and ".stamps" not in p.parts}
    return {p.relative_to(out).as_posix() for p, at in after.items() if before.get(p) != at}


def test_an_edit_redoes_what_follows_from_it_and_nothing_else(tree: Path) -> None:
    assert changed(tree, ("shot.py", "turns=3", "turns=2")) == {"shot.json"}
    assert changed(tree, ("shot.py", "# degrees;", "# in degrees;")) <= {"shot.json"}
    faster = changed(tree, ("mechanism.py", "speed: float = 2 * pi", "speed: float = 4 * pi"))
    assert faster == {"data.json", "skeleton.json", "clearance.json"}
    longer = changed(tree, ("mechanism.py", "rod: float = 0.100", "rod: float = 0.104"))
    assert {"data.json", "clearance.json", "parts/parts.json", "parts/rod.stl", "parts/rail_left.stl"} <= longer
    assert not {"shot.json", "parts/crank.stl", "parts/slider.stl", "parts/pin_A.step"} & longer


@pytest.mark.parametrize("scale", ["1:2", "1:7"])
def test_models_of_a_new_mechanism_are_clear(tree: Path, scale: str) -> None:
    """Their clearances are those that a printer needs, whatever the scale."""
    for command in ("parts", "clearance"):
        done = stage(tree, "mechanisms", command, "my_linkage", f"--scale={scale}")
        assert done.returncode == 0, (command, done.stderr)


def test_an_unknown_kind_is_refused_with_the_known_ones() -> None:
    with pytest.raises(UserError, match=r"no kind 'simulatd'.*driven: .*simulated: .*did you mean 'simulated'\?"):
        new.run("my_linkage", "simulatd")


def test_existing_files_are_not_touched() -> None:
    before = (MECHANISMS / "four_bar" / "mechanism.py").read_bytes()
    with pytest.raises(UserError, match=r"mechanisms/four_bar/mechanism.py is there already"):
        new.run("four-bar")
    assert (MECHANISMS / "four_bar" / "mechanism.py").read_bytes() == before


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("", r"make new NAME=my_linkage; there is already: .*four_bar"),
        ("3bar", "lower-case letters"),
        ("Watt", "lower-case letters"),
        ("../evil", "lower-case letters"),
        ("a b", "lower-case letters"),
        ("größe", "lower-case letters"),
        ("class", "a word of Python"),
        ("match", "a word of Python"),
        ("all", "make all"),
        ("films", "out/films"),
        ("night", "out/night"),
        ("site", "out/site"),
        ("gallery", "out/gallery"),
        ("showreel", "the film of all mechanisms"),
        ("ui_x", "scene-ui"),
        ("automatic", "has a module of this name"),
        ("stages", "has a module of this name"),
    ],
)
def test_an_unfit_name_is_refused(name: str, words: str) -> None:
    before = sorted(MECHANISMS.iterdir())
    with pytest.raises(UserError, match=words):
        new.run(name)
    assert sorted(MECHANISMS.iterdir()) == before
