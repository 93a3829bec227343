"""Changes are found by content, also where the system tells of none."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest

from studio.live import watching
from studio.live.watching import Watch


def test_a_change_without_an_event_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: dict[str, Any] = {}

    async def silent(*folders: Path, **options: Any) -> AsyncIterator[set[Any]]:
        asked.update(options)
        while True:
            await asyncio.sleep(0.01)
            yield set()

    monkeypatch.setattr(watching, "awatch", silent)
    file = tmp_path / "mechanism.py"
    file.write_text("a")

    async def first() -> set[Path]:
        changes = Watch(tmp_path).changes(lambda: False)
        waiting = asyncio.ensure_future(anext(changes))
        await asyncio.sleep(0.05)
        file.write_text("b")
        return await asyncio.wait_for(waiting, 20)

    assert asyncio.run(first()) == {file}
    assert asked["yield_on_timeout"], "it looks again when nothing is told"
    assert asked["rust_timeout"] <= 2000


def test_a_touch_is_no_change(tmp_path: Path) -> None:
    file = tmp_path / "mechanism.py"
    file.write_text("a")
    watch = Watch(tmp_path)
    file.touch()
    assert watch._changed({file}) == set()
    file.write_text("b")
    assert watch._changed({file}) == {file}


def test_a_file_that_was_saved_while_it_was_read_has_changed(tmp_path: Path) -> None:
    """Its content may have been read before the change; its name is known only afterwards."""
    (tmp_path / "folder").mkdir()
    watch = Watch(tmp_path / "folder")
    old, new = tmp_path / "old.txt", tmp_path / "new.txt"
    for file in (old, new):
        file.write_text("a")
    began = time.time()
    os.utime(old, (began - 60, began - 60))
    os.utime(new, (began + 1, began + 1))
    watch.follow([old, new], began)
    assert watch._changed(watch._all()) == {new}


def test_files_being_written_are_no_files_of_the_author(tmp_path: Path) -> None:
    watch = Watch(tmp_path)
    (tmp_path / ".mechanism-x7.py").write_text("half of it")
    assert watch._changed(watch._all()) == set()
