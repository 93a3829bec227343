"""Changes of the author's files, by their content: a touch is no change."""

from __future__ import annotations

import asyncio
import hashlib
import math
import os
from collections.abc import AsyncIterator, Callable, Iterable
from pathlib import Path

from watchfiles import awatch

DEBOUNCE, STEP = 120, 15
"""Milliseconds: changes within are one; and of quiet that end it sooner."""
LOOK_AGAIN = 1000
"""Milliseconds without a word from the system, after which contents are compared all the same: some file systems tell
of no change, and one can fall between two watches."""
COARSE = 0.05
"""Seconds by which the clock of a file system may be late."""
LARGEST = 1 << 26
"""Bytes of a file whose content is compared; of larger ones size and time."""


class Watch:
    """Watch over a folder and over single files elsewhere."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._files: set[Path] = set()
        self._states: dict[Path, str] = {}
        self._again = asyncio.Event()
        self._changed(self._all())

    def follow(self, files: Iterable[Path], since: float = math.inf) -> None:
        """Add these files; Python files of the folder are always watched.

        They were read at ``since`` (s since the epoch) or later; one that was written after that counts as changed, for
        what was read may be what it was before.
        """
        new = {Path(os.path.abspath(file)) for file in files} - self._files
        if not new:
            return
        self._files |= new
        for file in new:
            if file not in self._states and _written(file) < since - COARSE:
                self._states[file] = state(file)
        self._again.set()

    async def changes(self, ended: Callable[[], bool]) -> AsyncIterator[set[Path]]:
        """Yield sets of files whose content has changed, until ``ended``."""
        while not ended():
            self._again.clear()
            stop = asyncio.Event()
            waiting = asyncio.ensure_future(self._until_again(stop))
            try:
                folders = {self.folder, *(file.parent for file in self._files)}
                there = [folder for folder in folders if folder.is_dir()]
                watched = awatch(
                    *there, stop_event=stop, debounce=DEBOUNCE, step=STEP, recursive=False,
                    rust_timeout=LOOK_AGAIN, yield_on_timeout=True,
                )  # fmt: skip
                first = self._changed(self._all())  # what changed while nobody looked
                if first:
                    yield first
                async for _ in watched:
                    changed = self._changed(self._all())
                    if changed:
                        yield changed
                    if ended() or not self.folder.is_dir():
                        break
            except (OSError, RuntimeError):
                pass
            finally:
                waiting.cancel()
            if not ended() and not self._again.is_set():
                await asyncio.sleep(0.2)  # a folder that is gone may come back

    async def _until_again(self, stop: asyncio.Event) -> None:
        await self._again.wait()
        stop.set()

    def _all(self) -> set[Path]:
        try:
            own = {self.folder / name for name in os.listdir(self.folder) if name.endswith(".py") and name[0] != "."}
        except OSError:
            own = set()
        return own | self._files | {file for file in self._states if file.parent == self.folder}

    def _changed(self, files: set[Path]) -> set[Path]:
        changed = set()
        for file in files:
            now = state(file)
            if self._states.get(file) != now:
                changed.add(file)
            self._states[file] = now
        return changed


def state(file: Path) -> str:
    """Return a hash of a file's content, or a word if it is no file."""
    try:
        status = file.stat()
        if not os.path.isfile(file):
            return "folder"
        if status.st_size > LARGEST:
            return f"{status.st_size} {status.st_mtime_ns}"
        return hashlib.sha256(file.read_bytes()).hexdigest()
    except OSError:
        return "missing"


def _written(file: Path) -> float:
    """Return when a file was written last (s since the epoch); long ago if it is missing."""
    try:
        return file.stat().st_mtime
    except OSError:
        return -math.inf
