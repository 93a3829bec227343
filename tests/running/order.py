"""The order of the tests: quick files, so that a fault shows in the first minute, then the long ones, longest first.

A quick file is marked ``fast`` as well, if it is in a room that starts no program (``make test-fast``).
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from tests.running import samples

SECONDS = Path(__file__).with_name("seconds.json")
"""Seconds that each long group took; `make test PYTEST="... --record-seconds"` writes it anew."""
LONG = 4.0
"""Seconds from which a group is long. Groups that are not in the file are quick: a new file runs early."""
HEAVY = ("render", "studio", "mechanisms/gallery")
"""Folders of tests whose files load Blender, a browser or the gallery."""
UNKNOWN = 15.0
"""Seconds that are taken for a folder of mechanisms/ that is not in the file."""
FOLDERS = "test_mechanisms.py"
"""Its tests share what is made of one folder of mechanisms/, which takes long."""


def group_of(nodeid: str) -> str:
    """Tests of one group run in one process, as they share what a fixture made: those of a folder, else of a file."""
    file, _, test = nodeid.partition("::")
    if file.endswith(FOLDERS) and "[" in test:
        folder = test.rpartition("[")[2].rstrip("]").partition("-")[0]  # a variant is solved in its folder's group
        return f"{file}[{folder}]"
    return file


def recorded() -> dict[str, float]:
    """Seconds of the long groups."""
    return json.loads(SECONDS.read_text()) if SECONDS.exists() else {}


def place_of(group: str, seconds: dict[str, float]) -> float:
    """Return the key of a group: quick ones stay, then the longest first, so that all processes end together."""
    is_folder = group.partition("[")[0].endswith(FOLDERS)
    length = seconds.get(group, UNKNOWN if is_folder else 0.0)
    return 1.0 / length if length else 0.0


def is_fast(nodeid: str, seconds: dict[str, float]) -> bool:
    """Return True if a test belongs to ``make test-fast``."""
    group = group_of(nodeid)
    return group not in seconds and "[" not in group and not group.startswith(tuple(f"tests/{room}/" for room in HEAVY))


class Order:
    """Marks and sorts what is collected and spreads groups over the processes in that order."""

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Mark, before ``-m`` chooses, and sort by group; the order within a group stays."""
        seconds = recorded()
        samples.mark(items)
        for item in items:
            if is_fast(item.nodeid, seconds) and item.get_closest_marker("slow") is None:
                item.add_marker("fast")
        items.sort(key=lambda item: place_of(group_of(item.nodeid), seconds))

    @pytest.hookimpl(optionalhook=True)
    def pytest_xdist_make_scheduler(self, config: pytest.Config, log: Any) -> Any:
        """Hand out whole groups, first come first served."""
        from xdist.scheduler import LoadScopeScheduling

        class Groups(LoadScopeScheduling):
            def _split_scope(self, nodeid: str) -> str:
                return group_of(nodeid)

        return Groups(config, log) if config.getvalue("dist") == "loadscope" else None


class Recording:
    """Adds up the seconds of each group and writes those of the long ones (``--record-seconds``)."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """One phase of one test."""
        group = group_of(report.nodeid)
        self.seconds[group] = self.seconds.get(group, 0.0) + report.duration

    def pytest_sessionfinish(self) -> None:
        """Groups that did not run keep what is written of them."""
        SECONDS.write_text(written(recorded() | self.seconds))


def written(seconds: dict[str, float]) -> str:
    """The file's text: the long groups, longest first."""
    long = {group: round(time, 1) for group, time in _longest_first(seconds.items()) if time >= LONG}
    return json.dumps(long, indent=0) + "\n"


def _longest_first(items: Iterable[tuple[str, float]]) -> list[tuple[str, float]]:
    return sorted(items, key=lambda item: (-item[1], item[0]))
