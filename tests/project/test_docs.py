"""The documents are true: their Python runs, their commands exist, their links lead somewhere."""

from __future__ import annotations

import contextlib
import io
import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mechanisms.four_bar.mechanism import Params, build
from shared.stage.paths import ROOT
from tools.documents.figures.figures import PAGES

PUBLIC = ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md")
DOCUMENTS = [ROOT / name for name in PUBLIC] + sorted((ROOT / "docs").rglob("*.md"))
DRAWN = {ROOT / "docs" / f"{page}.md" for page in PAGES}
"""Pages with pictures, whose Python test_figures.py runs, too."""
BLOCK = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```$", flags=re.MULTILINE | re.DOTALL)


def blocks(document: Path, *languages: str) -> list[str]:
    return [code for language, code in BLOCK.findall(document.read_text()) if language in languages]


def make_targets(document: Path) -> set[str]:
    """Targets named as ``make target`` in code, inline or in a block; a placeholder like <name> is made real."""
    text = document.read_text()
    code = "\n".join(re.findall(r"`([^`\n]+)`", text)) + "\n" + "\n".join(code for _, code in BLOCK.findall(text))
    code = re.sub(r'="[^"]*"', "=x", code)
    targets = set()
    for line in re.findall(r"\bmake ((?:[a-z][a-z_<>-]*|[A-Z]+=\S+)(?: (?:[a-z][a-z_<>-]*|[A-Z]+=\S+))*)", code):
        targets |= {word.replace("<name>", "four-bar") for word in line.split() if "=" not in word}
    return targets


def test_the_readme_has_one_block_of_code_which_is_the_four_bar() -> None:
    (shown,) = blocks(ROOT / "README.md", "python")
    variables: dict[str, Any] = {}
    with contextlib.redirect_stdout(io.StringIO()):
        exec(shown, variables)
    wanted = build(Params()).sweep().point("P")
    for name in ("x", "y"):
        np.testing.assert_allclose(getattr(variables["sol"].point("P"), name), getattr(wanted, name), atol=1e-9)


RUN = [document for document in DOCUMENTS if document not in DRAWN and blocks(document, "python", "py")]


@pytest.mark.parametrize("document", RUN, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_python_blocks_run(document: Path, tmp_path: Path) -> None:
    """In order, in one process, from the project's folder."""
    code = "\n".join(blocks(document, "python", "py"))
    environment = os.environ | {"MBSD_OUT": str(tmp_path), "MPLBACKEND": "Agg", "PYTHONPATH": str(ROOT)}
    script = tmp_path / "document.py"
    script.write_text(code)
    done = subprocess.run([sys.executable, str(script)], cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_extending_uses_the_public_doors_alone() -> None:
    page = ROOT / "docs" / "extending.md"
    imported = {name for code in blocks(page, "python") for name in re.findall(r"^from ([\w.]+) import", code, re.M)}
    ours = {name for name in imported if name.split(".")[0] in ("mbsd", "tests", "tools")}
    assert ours == {"mbsd", "mbsd.extend", "mbsd.extend.derivatives", "mbsd.extend.integrators", "mbsd.testing"}


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_make_targets_exist(document: Path) -> None:
    for target in sorted(make_targets(document)):
        assert not refused_by_make(target), f"{document.name} names make {target}: {refused_by_make(target)}"


@cache
def refused_by_make(target: str) -> str:
    """Return the complaint of make about a target, if any."""
    environment = {key: value for key, value in os.environ.items() if key not in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS")}
    done = subprocess.run(["make", "-n", target], cwd=ROOT, env=environment, capture_output=True, text=True)
    return done.stderr or "it fails" if done.returncode else ""


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_links_lead_to_files(document: Path) -> None:
    for link in re.findall(r"\]\(([^)#\s]+)", document.read_text()) + re.findall(
        r'src="([^"]+)"', document.read_text()
    ):
        if not link.startswith(("http://", "https://", "mailto:")):
            assert (document.parent / link).exists(), f"{document.name} links to {link}"


def test_the_readme_is_short_and_shows_the_two_commands() -> None:
    text = (ROOT / "README.md").read_text()
    assert len(text.splitlines()) <= 110
    assert (
        text.index("mbsd run")
        < text.index("from mbsd import")
        < text.index("make run-four-bar")
        < text.index("make test")
    )


HEADING = re.compile(r"^#{1,6} (.+)$", flags=re.MULTILINE)
ANCHORED = re.compile(r"\]\(([^)#\s]*\.md)?#([^)\s]+)\)")


def anchors(document: Path) -> set[str]:
    """Return the anchors of a page as forges and the site make them of its headings."""
    text = re.sub(r"^```.*?^```$", "", document.read_text(), flags=re.MULTILINE | re.DOTALL)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in HEADING.findall(text)}


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_links_to_sections_lead_to_headings(document: Path) -> None:
    for page, anchor in ANCHORED.findall(document.read_text()):
        target = (document.parent / page).resolve() if page else document
        assert anchor in anchors(target), f"{document.name} links to {page}#{anchor}"


WORDS = {
    r"refus\w*": "raises an error",
    r"made again|makes? again": "rebuilt",
    r"(?<!virtual )machines?(?! code| addresses)": "mechanism, or computer",
    r"strays?": "varies",
}
"""One word for one thing: words of our own, and what the pages say instead."""
PAGES = [page for page in DOCUMENTS if page.parent == ROOT / "docs" or "decisions" in page.parts or page.parent == ROOT]


@pytest.mark.parametrize("word", WORDS)
def test_pages_have_one_word_for_one_thing(word: str) -> None:
    uses = [
        f"{page.name}: {line.strip()[:80]}"
        for page in PAGES
        if page.name not in ("CHANGELOG.md", "CONTRIBUTING.md", "benchmarks.md")
        for line in re.sub(r"^```.*?^```|`[^`]*`|\]\([^)]*\)", "", page.read_text(), flags=re.M | re.S).splitlines()
        if re.search(rf"\b(?:{word})\b", line)
    ]
    assert not uses, f"say {WORDS[word]}: " + "; ".join(uses)


def test_pages_are_short_enough_to_be_finished() -> None:
    lines = {page: len(page.read_text().splitlines()) for page in DOCUMENTS if page.is_relative_to(ROOT / "docs")}
    assert sum(lines.values()) <= 7000
    changes = (ROOT / "CHANGELOG.md").read_text()
    assert len(changes.splitlines()) <= 150
    assert len(changes.split()) <= 3000


def test_pictures_are_small_enough_for_a_clone() -> None:
    pictures = [path for path in (ROOT / "docs").rglob("*") if path.suffix in (".svg", ".png", ".jpg", ".gif")]
    assert len(pictures) > 10
    large = {path.name: path.stat().st_size for path in pictures if path.stat().st_size > 300_000}
    assert not large
