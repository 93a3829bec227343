"""Changes are found by content, also where the system tells of none."""

from __future__ import annotations

import asyncio
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
    assert watch._changed({file}) == {file}
    file.touch()
    assert watch._changed({file}) == set()
