"""The Makefile: its targets, its words, and what it asks before it begins; tests/studio/command/ has its plans."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from shared.stage.paths import ROOT
from tests.running.make import MAKEFILE, run


def test_help_is_the_default_and_has_a_line_for_every_target() -> None:
    done = run("make")
    assert done.stdout == run("make", "help").stdout
    listed = re.findall(r"^  (\S+) ", done.stdout, flags=re.MULTILINE)
    targets = [
        t.replace("-%", "-<name>") for t in re.findall(r"^([a-z][a-z-]*(?:-%)?):(?!=)", MAKEFILE, flags=re.MULTILINE)
    ]
    assert listed == [target for target in targets if target != "always"]
    wanted = "help check install list run-<name> solve-<name> parts-<name> clearance-<name> plot-<name> still-<name> "
    wanted += "poster-<name> frames-<name> film-<name> scene-<name> scene-ui-<name> run-all all new test lint bench "
    wanted += "bench-start bench-live readme-loop animate-<name> report-<name> glb-<name> contact-<name> gallery "
    wanted += "clean clean-all test-fast test-slow test-all"
    assert set(wanted.split()) <= set(listed)
    assert max(map(len, done.stdout.splitlines())) <= 120


@pytest.mark.parametrize(
    ("words", "known"),
    [
        ("PRESET=big", "draft preview production final"),
        ("PRESET=draft preview final x", "draft preview production final"),
        ("ASPECT=3:2", "16:9 1:1 4:5 9:16"),
        ("ASPECT=9:16 1:1", "16:9 1:1 4:5 9:16"),
        ("ASPECT=16/9", "16:9 1:1 4:5 9:16"),
    ],
)
def test_an_unknown_preset_or_aspect_is_refused_with_the_known_ones(words: str, known: str) -> None:
    done = run("make", "help", words)
    assert done.returncode != 0
    assert f"choose one of: {known}" in done.stderr


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("run-nope",), r"error: there is no mechanism 'nope' in mechanisms/; there is: .*four_bar"),
        (("compare-nope",), r"there is no mechanism 'nope'"),
        (("compare-pantograph",), r"pantograph: there is nothing to compare; write VARIANTS"),
        (("new", "NAME=my_linkage", "KIND=simulatd"), r"did you mean 'simulated'\?"),
        (("new",), r"(?s)make new NAME=my_linkage.*four_bar|four_bar.*make new NAME=my_linkage"),
    ],
)
def test_invalid_options_are_an_error_with_a_remedy_before_anything_runs(words: tuple[str, ...], error: str) -> None:
    done = run("make", "-o", "install", "-o", "libraries", *words)
    assert done.returncode != 0
    assert re.search(error, done.stderr)
    assert "Traceback" not in done.stderr
    assert done.stdout == ""


def test_the_makefile_keeps_to_make_3_81_and_a_posix_shell() -> None:
    newer = (
        r"\.ONESHELL",
        r"!=",
        r"\$\(file ",
        r"^undefine",
        r"::=",
        r"\.SHELLSTATUS",
        r"\$\(let ",
        r"\$\(intcmp ",
        r"&:",
    )
    for construct in newer:
        assert not re.search(construct, MAKEFILE, flags=re.MULTILINE), construct
    # 3.81 takes the first pattern that fits, later ones take the longest.
    assert MAKEFILE.index("\nscene-ui-%:") < MAKEFILE.index("\nscene-%:")
    shell = shutil.which("dash") or "sh"
    for script in sorted((ROOT / "tools").glob("*.sh")):
        assert run(shell, "-n", str(script)).returncode == 0, script
        assert not re.search(
            r"\[\[|^ *local |^ *function |<<<|\bpipefail\b|\$'", script.read_text(), flags=re.MULTILINE
        ), script


def test_tests_and_measurements_wait_for_all_kernels() -> None:
    for target in ("test", "test-fast", "test-slow", "test-all", "bench-start", "check-numbers", "check-events"):
        done = run("make", "-n", "-o", "install", target)
        [line] = [number for number, text in enumerate(done.stdout.splitlines()) if "-m tools.compiling wait" in text]
        assert line == (1 if target.startswith("test") else 0), (
            "before the first test, after a word on missing programs"
        )


def test_missing_libraries_end_parts_and_pictures_before_they_begin(tmp_path: Path) -> None:
    """install leaves a file where all were found; what needs none of them goes on."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    (tmp_path / ".venv").mkdir()
    for target in ("run-four-bar", "film-four-bar", "parts-four-bar", "overnight"):
        done = run("make", "-o", "install", "PYTHON=echo", target, cwd=tmp_path)
        assert done.returncode != 0
        assert "error: parts and pictures need these libraries; nothing was built" in done.stderr
        assert done.stdout == ""
    assert run("make", "-o", "install", "PYTHON=echo", "animate-four-bar", cwd=tmp_path).returncode == 0
    (tmp_path / ".venv" / "libraries-found").touch()
    assert run("make", "-o", "install", "PYTHON=echo", "run-four-bar", cwd=tmp_path).returncode == 0


def test_clean_removes_the_results_and_leaves_a_folder_of_the_users_alone(tmp_path: Path) -> None:
    (tmp_path / "tools").mkdir()
    shutil.copy(ROOT / "tools" / "clean.sh", tmp_path / "tools")
    (tmp_path / "out" / "four_bar").mkdir(parents=True)
    mine = tmp_path / "mine"
    mine.mkdir()
    done = run("sh", "tools/clean.sh", cwd=tmp_path, MBSD_OUT=str(mine))
    assert done.returncode == 0
    assert not (tmp_path / "out").exists()
    assert mine.exists()
    assert str(mine) in done.stderr
    (mine / "data.json").touch()
    (tmp_path / "out").symlink_to(mine)
    done = run("sh", "tools/clean.sh", cwd=tmp_path)
    assert (done.returncode, (tmp_path / "out").is_symlink(), (mine / "data.json").exists()) == (0, True, True)
    assert f"out is a link, so it and the folder it leads to are left to you: {mine}" in done.stderr
