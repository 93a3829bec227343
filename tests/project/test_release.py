"""``make release``: its pieces, on small trees that break each promise once."""

from __future__ import annotations

import json
import subprocess
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mbsd
from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from tools.release import __main__ as program
from tools.release.archives import FOUR_BAR, clone, commit_time, differences, dirt, sums
from tools.release.checks import CHECKS, faults_of_licences, packages_of_the_page
from tools.release.written import disagreements, faults_of_citation, notes, versions

CHANGELOG = """# Changelog

## Unreleased

- A change to come.

## 1.2.0 - 2026-11-28

Short.

### Added

- A thing.

### History

- Every change.

## 1.1.0

- An older thing.
"""
CITATION = "cff-version: '1.2.0'\nmessage: m\ntitle: t\nauthors:\n- name: a\nversion: '1.2.0'\n"


def tree(folder: Path, **other: str) -> Path:
    """A clone in which all says 1.2.0, but for what ``other`` says by the first word of a file's name."""
    said = dict.fromkeys(("pyproject", "init", "citation", "changelog"), "1.2.0") | other
    (folder / "mbsd").mkdir()
    (folder / "pyproject.toml").write_text(f'[project]\nversion = "{said["pyproject"]}"\n')
    (folder / "mbsd" / "__init__.py").write_text(f'__version__ = "{said["init"]}"\n')
    (folder / "CITATION.cff").write_text(
        CITATION.replace("1.2.0", "@").replace("@", "1.2.0", 1).replace("@", said["citation"])
    )
    (folder / "CHANGELOG.md").write_text(CHANGELOG.replace("1.2.0", said["changelog"]))
    return folder


def test_a_tree_that_agrees_has_no_fault(tmp_path: Path) -> None:
    assert versions(tree(tmp_path)) == dict.fromkeys(versions(tmp_path), "1.2.0")
    assert disagreements(versions(tmp_path)) == []


@pytest.mark.parametrize(
    ("place", "file"), [("init", "mbsd/__init__.py"), ("citation", "CITATION.cff"), ("changelog", "CHANGELOG.md")]
)
def test_each_place_that_says_another_version_is_named(tmp_path: Path, place: str, file: str) -> None:
    said = disagreements(versions(tree(tmp_path, **{place: "1.3.0"})))
    assert said == [f"{file} says 1.3.0 where pyproject.toml says 1.2.0"]


def test_a_place_without_a_version_is_named(tmp_path: Path) -> None:
    (tree(tmp_path) / "CITATION.cff").unlink()
    assert disagreements(versions(tmp_path)) == ["CITATION.cff says no version where pyproject.toml says 1.2.0"]


def test_this_clone_agrees_with_itself() -> None:
    assert versions(ROOT)["mbsd/__init__.py"] == mbsd.__version__
    assert disagreements(versions(ROOT)) == []


def test_notes_are_the_section_of_the_version_without_its_history() -> None:
    assert notes(CHANGELOG, "1.2.0") == "# mbsd 1.2.0\n\nShort.\n\n### Added\n\n- A thing.\n"
    assert notes(CHANGELOG, "1.1.0") == "# mbsd 1.1.0\n\n- An older thing.\n"


@pytest.mark.parametrize(
    ("changelog", "wrong"), [(CHANGELOG, "has no section '## 2.0.0'"), ("## 2.0.0\n\nSoon.\n", "lists nothing")]
)
def test_a_version_of_which_nothing_is_said_is_refused(changelog: str, wrong: str) -> None:
    with pytest.raises(UserError, match=wrong):
        notes(changelog, "2.0.0")


def test_the_citation_of_this_clone_is_complete() -> None:
    assert faults_of_citation((ROOT / "CITATION.cff").read_text()) == []


@pytest.mark.parametrize(
    ("old", "new", "wrong"),
    [
        ("title: t\n", "", "CITATION.cff has no title"),
        ("message: m", "massage: m", "CITATION.cff has an unknown field massage"),
        ("version: '1.2.0'\n", "version: 1.2\n", "version is 1.2, no string; write it in quotes"),
        ("- name: a", "- email: a", "an author has no name: {'email': 'a'}"),
        ("title: t", "title: [", "CITATION.cff is no YAML"),
        ("title: t", "title: t\ndate-released: soon", "date-released is 'soon'; YYYY-MM-DD"),
    ],
)
def test_missing_lines_of_the_citation_are_named(old: str, new: str, wrong: str) -> None:
    assert any(fault.startswith(wrong) for fault in faults_of_citation(CITATION.replace(old, new)))


LICENCES = ["m-1.dist-info/licenses/LICENSE", "m-1.dist-info/licenses/NOTICE.md"]


def test_a_wheel_of_our_files_with_both_licences_passes() -> None:
    assert faults_of_licences([*LICENCES, "mbsd/__init__.py", "mbsd/rooms/render/view/bundle.py"], ROOT) == []


def test_missing_and_foreign_files_of_a_wheel_are_named(tmp_path: Path) -> None:
    lock = tmp_path / "render" / "view" / "page" / "package-lock.json"
    lock.parent.mkdir(parents=True)
    entries = {"": {}, "node_modules/a": {"version": "1", "license": "ISC"}, "node_modules/b": {"dev": True}}
    lock.write_text(json.dumps({"packages": entries}))
    (tmp_path / "NOTICE.md").write_text("| a | MIT | x |\n")
    (tmp_path / "render" / "taken.py").write_text("# Copyright 1999 Somebody\n")
    assert packages_of_the_page(tmp_path) == [("a", "1", "ISC")]
    assert faults_of_licences(
        [LICENCES[0], "mbsd/rooms/render/letters.ttf", "mbsd/rooms/render/taken.py"], tmp_path
    ) == [
        "the wheel has no NOTICE.md",
        "mbsd/rooms/render/letters.ttf is in the wheel and not in NOTICE.md; whose is it?",
        "mbsd/rooms/render/taken.py speaks of a licence and is not in NOTICE.md",
        "a 1 (ISC) goes into pages and is not in NOTICE.md",
    ]


def wheel(path: Path, content: str, time: tuple[int, int, int, int, int, int] = (1980, 1, 1, 0, 0, 0)) -> Path:
    path.parent.mkdir(exist_ok=True)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(zipfile.ZipInfo("m/a.py", time), content)
        archive.writestr(zipfile.ZipInfo("m/b.py", (1980, 1, 1, 0, 0, 0)), "")
    return path


def test_archives_that_differ_are_named_with_their_members(tmp_path: Path) -> None:
    first, same = wheel(tmp_path / "1" / "m.whl", "x = 1"), wheel(tmp_path / "2" / "m.whl", "x = 1")
    assert differences([first], [same]) == []
    assert differences([first], [wheel(tmp_path / "3" / "m.whl", "x = 2")]) == ["m.whl (m/a.py)"]
    assert differences([first], [wheel(tmp_path / "4" / "m.whl", "x = 1", (1990, 1, 1, 0, 0, 0))]) == ["m.whl (m/a.py)"]
    assert differences([first], []) == ["m.whl"]


def test_the_sums_are_those_of_sha256sum(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("a\n")
    assert sums([path]) == "87428fc522803d31065e7bce3cf03fe475096631e5e07bbd7a0fde60c4cf25c7  a.txt\n"


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A clone of one commit of 2001."""
    folder = tmp_path / "repository"
    folder.mkdir()
    (folder / "a.txt").write_text("committed\n")
    (folder / "pyproject.toml").write_text('version = "3.0"\n')
    (folder / ".gitignore").write_text("out/\n")
    who = ["-c", "user.name=a", "-c", "user.email=a@b.c"]
    for words in (["init", "-q"], ["add", "."], [*who, "commit", "-q", "-m", "a", "--date=2001-01-01T00:00Z"]):
        subprocess.run(
            ["git", *words],
            cwd=folder,
            check=True,
            env={"GIT_COMMITTER_DATE": "978307200 +0000", "PATH": "/usr/bin:/bin"},
        )
    return folder


def test_a_clone_has_what_is_committed_and_dirt_is_what_is_not(repository: Path, tmp_path: Path) -> None:
    assert dirt(repository) == []
    (repository / "a.txt").write_text("changed\n")
    (repository / "new.txt").touch()
    (repository / "out").mkdir()
    (repository / "out" / "result").touch()
    assert dirt(repository) == ["a.txt", "new.txt"]
    copy = clone(repository, tmp_path / "copy")
    assert (copy / "a.txt").read_text() == "committed\n"
    assert commit_time(copy) == 978307200


def test_the_four_bar_of_a_new_environment_is_solved_here_too() -> None:
    variables: dict[str, Any] = {}
    exec(FOUR_BAR, variables)
    assert np.degrees(np.ptp(variables["r"])) == pytest.approx(56.44, abs=0.01)


def test_every_failure_is_named_and_nothing_is_written(
    repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """In a clone that has a version, no change log, no citation, and a file too many."""
    (repository / "new.txt").touch()
    names = ("clean tree", "same version", "citation", "notes")
    monkeypatch.setattr(program, "ROOT", repository)
    monkeypatch.setattr(program, "CHECKS", {name: CHECKS[name] for name in names})
    monkeypatch.setattr("sys.argv", ["release", "--out", str(tmp_path / "dist")])
    with pytest.raises(UserError, match="4 of 4 checks failed: clean tree, same version, citation, notes"):
        program.main()
    said = capfd.readouterr().err
    assert "clean tree: new.txt is not committed" in said
    assert "same version: mbsd/__init__.py says no version where pyproject.toml says 3.0" in said
    assert "citation: there is no CITATION.cff" in said
    assert "notes: there is no CHANGELOG.md" in said
    assert not (tmp_path / "dist").exists()


def test_an_unknown_check_is_refused_with_those_that_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.argv", ["release", "--only", "luck"])
    with pytest.raises(UserError, match="no check is called 'luck'; there is: clean tree, same version"):
        program.main()
