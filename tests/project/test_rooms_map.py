"""The map of rooms in ARCHITECTURE.md is what their docstrings say now."""

from __future__ import annotations

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
