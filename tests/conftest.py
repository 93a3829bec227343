"""What every test file may use."""

from __future__ import annotations

import os
import signal
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

settings.register_profile("local", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ci" if os.environ.get("CI") else "local")

# What a shell starts in the background, or nohup, ignores these, and so would all that the tests start and interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


FOLDERS = "test_mechanisms.py"
"""Its tests share what is made of one folder of mechanisms/, which takes long."""


def group_of(nodeid: str) -> str:
    """Tests of one group run in one process, as they share what a fixture made: those of a folder, else of a file."""
    file, _, test = nodeid.partition("::")
    if file.endswith(FOLDERS) and "[" in test:
        return f"{file}[{test.rpartition('[')[2]}"
    return file


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The long groups first: folders, then files by their number of tests."""
    counts = Counter(item.path for item in items)
    items.sort(key=lambda item: (item.path.name != FOLDERS, 0 if item.path.name == FOLDERS else -counts[item.path]))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Spread groups over the processes, in the order of collection."""
    from xdist.scheduler import LoadScopeScheduling

    class Groups(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return group_of(nodeid)

    return Groups(config, log) if config.getvalue("dist") == "loadscope" else None


@pytest.fixture
def out_root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder for results, in this process and in the ones it starts."""
    folder = tmp_path / "out"
    monkeypatch.setenv("MBSD_OUT", str(folder))
    return folder
