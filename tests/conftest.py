"""What every test file may use."""

from __future__ import annotations

import os
import signal
from collections import Counter
from pathlib import Path

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


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Tests that share what a fixture made run in one process (``--dist loadgroup``), the long groups first.

    These are the tests of a file, unless the fixture's values are groups by marks of their own, which are long.
    """
    own = {item for item in items if item.get_closest_marker("xdist_group")}
    counts = Counter(item.path for item in items if item not in own)
    for item in items:
        if item not in own:
            item.add_marker(pytest.mark.xdist_group(item.path.stem))
    items.sort(key=lambda item: (item not in own, 0 if item in own else -counts[item.path]))


@pytest.fixture
def out_root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder for results, in this process and in the ones it starts."""
    folder = tmp_path / "out"
    monkeypatch.setenv("MBSD_OUT", str(folder))
    return folder
