"""Names, frames and targets of a user are never executed, and links never lead to files of others."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from mechanisms.stages import listing
from render.blender.child import blender
from render.frames.store import FrameStore
from shared.stage import paths
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import ROOT, Out, mechanism_name
from shared.stage.stages import Stage
from studio.night.plan import options
from tests.running.make import run
from tools.fixtures import film_fixture

NASTY = [
    "$(touch pwned)",
    "$$(touch pwned)",
    "$(shell touch pwned)",
    "${shell touch pwned}",
    "$(error pwned)",
    "`touch pwned`",
    "x; touch pwned",
    "x' ; touch pwned ; '",
    'x" ; touch pwned ; "',
    "x\n\ttouch pwned",
    "x && touch pwned #",
    "| touch pwned",
    "> pwned",
    "!pwned",
    "%",
    "../../pwned",
    "-x",
    "--help",
    "\\",
    "größe",
    "a b",
    "*",
]


WORDS = (
    "KIND",
    "FRAME",
    "ONLY",
    "WATTS",
    "ANYWAY",
    "VIEW",
    "SHOW",
    "SPECTRA",
    "OVER",
    "BED",
    "SCALE",
    "STORY",
    "SOUND",
)
SAY = f"""#!/bin/sh
printf '<%s>\\n' "$@"
for name in {" ".join(WORDS)}; do eval "printf '%s=<%s>\\n' $name \\"\\$$name\\""; done
"""
"""A Python that says what it is asked for, and the words of make that it reads from its environment."""


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The Makefile with its tools, nothing to install, and two mechanisms."""
    folder = tmp_path_factory.mktemp("makefile") / "tree"
    (folder / "tools").mkdir(parents=True)
    (folder / "tools" / "install.sh").write_text("exit 0\n")
    shutil.copy(ROOT / "Makefile", folder)
    (folder / "say").write_text(SAY)
    (folder / "say").chmod(0o755)
    for name in ("arm", "four_bar"):
        (folder / "mechanisms" / name).mkdir(parents=True)
        (folder / "mechanisms" / name / "mechanism.py").touch()
    return folder


def make(tree: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run make there, with a Python that says what it is asked for, a word a line."""
    return run("make", "PYTHON=./say", *arguments, cwd=tree, **environment)


def files_of(tree: Path) -> set[str]:
    return {path.relative_to(tree.parent).as_posix() for path in tree.parent.rglob("*")}


@pytest.mark.parametrize("word", NASTY)
def test_words_reach_python_as_they_are(tree: Path, word: str) -> None:
    """On the command line of make and in its environment."""
    before = files_of(tree)
    for words in (([f"{name}={word}" for name in ("NAME", *WORDS)], {}), ([], dict.fromkeys(("NAME", *WORDS), word))):
        done = make(tree, "new", *words[0], **words[1])
        assert f"<studio.command>\n<new>\n<-->\n<{word}>\n" in done.stdout, done.stderr
        assert done.stdout.endswith("".join(f"{name}=<{word}>\n" for name in WORDS))
    done = make(tree, "film-x", f"PRESET={word}")
    assert done.returncode != 0
    assert "is not a preset; choose one of: draft preview production final" in done.stderr
    assert files_of(tree) == before


@pytest.mark.parametrize("word", NASTY)
def test_a_target_reaches_python_as_it_is(tree: Path, word: str) -> None:
    before = files_of(tree)
    done = make(tree, f"run-{word}")
    if "/" in word:
        assert "No rule to make target" in done.stderr
    else:
        assert f"<run>\n<-->\n<{word.replace('-', '_')}>\n" in done.stdout, done.stderr
    assert files_of(tree) == before


def test_a_folder_that_is_no_name_is_told_and_never_executed(
    tree: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["$(touch pwned)", "`touch pwned`", "x=y", "a b", "Watt", "-n", "x;touch pwned", "größe"]
    for word in words:
        (tree / "mechanisms" / word).mkdir()
        (tree / "mechanisms" / word / "mechanism.py").write_text("open('pwned', 'w')")
    before = files_of(tree)
    try:
        monkeypatch.setattr(paths, "MECHANISMS", tree / "mechanisms")
        asked = options.options("", "draft", "", "", "", "")
        listing.run()
    finally:
        for word in words:
            shutil.rmtree(tree / "mechanisms" / word)
    assert asked.names == ("arm", "four_bar")
    assert set(asked.unfit) == set(words)
    said = capsys.readouterr()
    assert [line.split()[0] for line in said.out.splitlines() if not line.startswith(" ")] == ["arm", "four-bar"]
    for word in words:
        assert f"{word!r} is left out" in said.err
    assert before - files_of(tree) == {path for path in before if any(f"mechanisms/{word}" in path for word in words)}
    assert not files_of(tree) - before


@pytest.mark.parametrize(
    "command",
    [
        ("mechanisms", "new", "--", "$(touch pwned)"),
        ("mechanisms", "parts", "../x"),
        ("render", "plots", "x;y"),
        ("render", "film", "../../x"),
    ],
)
def test_python_refuses_what_is_no_name(out_root: Path, command: tuple[str, ...]) -> None:
    done = subprocess.run([sys.executable, "-m", *command], cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith(f"error: {command[-1]!r} ")
    assert "write lower-case letters, digits and underscores (or hyphens), a letter first" in done.stderr
    assert not out_root.exists()


@pytest.mark.parametrize("word", [*NASTY, "", "films/../x", "Watt"])
def test_no_path_is_made_of_what_is_no_name(word: str) -> None:
    if word == "-x":
        word = "x/../../y"
    with pytest.raises(UserError, match="is not the name of a mechanism: write lower-case letters"):
        Out(word)


def test_hyphens_and_a_slash_of_the_shells_completion_are_taken() -> None:
    assert mechanism_name("four-bar/") == mechanism_name(" four_bar") == "four_bar"


@pytest.fixture
def foreign(tmp_path: Path) -> Path:
    """A folder of someone else's, with files of the names that stages make."""
    folder = tmp_path / "foreign"
    folder.mkdir()
    for name in ("mine.stl", "mine.png", ".old.part.png", "parts.json", "path.png", "0.json", ".parts-1.json"):
        (folder / name).write_text(name)
        os.utime(folder / name, (1, 1))
    (folder / "draft").mkdir()
    (folder / "draft" / "mine.png").write_text("mine")
    (folder / "tmp-1").mkdir()
    (folder / "tmp-1" / "mine").write_text("mine")
    return folder


def contents(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    "link", ["four_bar", "four_bar/parts", "four_bar/plots", "four_bar/.stamps", "four_bar/frames"]
)
def test_a_stage_refuses_a_link_in_place_of_a_folder_of_results(out_root: Path, foreign: Path, link: str) -> None:
    film_fixture.write()
    before = contents(foreign)
    place = out_root / link
    if place.exists():
        shutil.rmtree(place)
    place.parent.mkdir(parents=True, exist_ok=True)
    place.symlink_to(foreign)
    for command in (("mechanisms", "parts"), ("mechanisms", "shot"), ("render", "plots"), ("render", "film")):
        done = subprocess.run(
            [sys.executable, "-m", *command, "four_bar"], cwd=ROOT, capture_output=True, text=True, timeout=120
        )
        assert done.returncode == 1, (command, done.stdout)
        if link == "four_bar" and command[0] == "render":
            continue  # there are no files in it to make pictures of
        assert f"error: {place} is a link to {foreign}; stages overwrite and delete files" in done.stderr
        assert f"remove it (rm {place})" in done.stderr
    assert contents(foreign) == before


def test_nothing_is_written_or_swept_through_a_link(out_root: Path, foreign: Path) -> None:
    before = contents(foreign)
    out = Out("four_bar")
    (out_root / "four_bar" / "frames").mkdir(parents=True)
    out.frames("draft").symlink_to(foreign)
    with pytest.raises(UserError, match="is a link to"), FrameStore(out.frames("draft")).locked():
        pass
    (out_root / "films").symlink_to(foreign)
    with pytest.raises(UserError, match="films is a link to"):
        Stage(out, "film", "key", [out.film("draft")])
    with pytest.raises(UserError, match="films is a link to"):
        write_bytes(out.film("draft"), b"film")
    (out_root / ".blender").symlink_to(foreign)
    with pytest.raises(UserError, match=r"\.blender is a link to"), blender(None):  # pyright: ignore[reportArgumentType]
        pass
    assert contents(foreign) == before


def test_a_link_in_place_of_a_file_is_replaced_and_not_followed(out_root: Path, foreign: Path) -> None:
    out = Out("four_bar")
    out.folder.mkdir(parents=True)
    out.motion.symlink_to(foreign / "parts.json")
    before = contents(foreign)
    write_bytes(out.motion, b"motion")
    assert (out.motion.read_bytes(), out.motion.is_symlink(), contents(foreign)) == (b"motion", False, before)


def test_the_folder_of_all_results_may_be_a_link(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    disk = tmp_path / "disk"
    disk.mkdir()
    (tmp_path / "out").symlink_to(disk)
    monkeypatch.setattr(paths, "out_root", lambda: tmp_path / "out")
    out = Out("four_bar")
    write_bytes(out.motion, b"motion")
    Stage(out, "solve", "key", [out.motion]).record()
    assert (disk / "four_bar" / "data.json").read_bytes() == b"motion"
