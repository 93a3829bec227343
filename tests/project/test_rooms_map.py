"""The map of rooms in ARCHITECTURE.md is what their docstrings say now; what maps and decisions name exists."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from shared.stage.paths import ROOT
from tools import rooms


def test_the_map_is_up_to_date() -> None:
    done = subprocess.run([sys.executable, str(ROOT / "tools" / "rooms.py"), "--check"], check=False)
    assert done.returncode == 0, "docstrings of rooms have changed: make docs"


def test_a_page_without_a_place_for_the_map_is_refused() -> None:
    with pytest.raises(ValueError, match="no place for the map"):
        rooms.written("# Architecture\n")


def test_every_room_is_on_the_map_once() -> None:
    folders = [row.split("`")[1] for row in rooms.table().splitlines()[2:]]
    assert len(folders) == len(set(folders))
    assert {"mbsd/", "mechanisms/stages/automatic/", "render/film/", "shared/contract/"} <= set(folders)
    for room in rooms.DEPTH:
        below = {f"{file.parent.relative_to(ROOT).as_posix()}/" for file in (ROOT / room).glob("*/__init__.py")}
        assert below <= set(folders)


NAMING = [ROOT / "ARCHITECTURE.md", ROOT / "docs" / "map.md", *sorted((ROOT / "docs" / "decisions").rglob("*.md"))]


def test_files_and_folders_that_maps_and_decisions_name_exist() -> None:
    sources = [
        file.relative_to(ROOT)
        for room in ("benchmarks", "docs", "mbsd", "mechanisms", "render", "shared", "studio", "tests", "tools")
        for file in (ROOT / room, *(ROOT / room).rglob("*"))
        if "node_modules" not in file.parts
    ]
    known = {f"/{file.as_posix()}" for file in sources}
    for page in NAMING:
        for name in re.findall(r"`([\w./-]+(?:\.(?:py|js|md)|/))`", page.read_text()):
            ending = f"/{name.rstrip('/')}"
            assert any(path.endswith(ending) for path in known), f"{page.relative_to(ROOT)} names {name}"


def test_every_decision_is_listed_and_is_one_thing() -> None:
    folder = ROOT / "docs" / "decisions"
    index = folder / "README.md"
    listed = set(re.findall(r"\]\(([a-z-]+(?:/[a-z-]+)?\.md)\)", index.read_text()))
    assert listed == {file.relative_to(folder).as_posix() for file in folder.rglob("*.md")} - {"README.md"}
    for file in folder.rglob("*.md"):
        if file.name not in ("README.md", "first-design.md"):
            assert re.findall(r"^#+ ", file.read_text(), flags=re.MULTILINE) == ["# "], file


def test_the_map_of_rooms_has_two_pages() -> None:
    text = (ROOT / "ARCHITECTURE.md").read_text()
    assert len(text.splitlines()) <= 120
    assert max(len(line) for line in text.splitlines() if not line.startswith("|")) <= 135
