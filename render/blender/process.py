"""The time and the place of a Blender process: how long it may be silent, and its scratch folder."""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from shared.stage import files
from shared.stage.paths import refuse_links

# How long Blender may be silent before it counts as hanging.

START = 300.0
"""Seconds until the first picture, in which Blender is loaded and the scene is built."""
KERNELS = 1800.0
"""Seconds for the drivers of a GPU to compile Cycles, once on a machine."""
FLOOR = 120.0
"""Seconds for everything else, however short a picture takes."""
TIMES = 10.0
"""Multiple of the longest picture so far: a machine may become that busy."""
LONGEST = 6 * 3600.0
"""Seconds that no silence is longer than, whatever a timing.json says."""
VARIABLE = "MBSD_PATIENCE"
"""Environment variable with seconds to take in place of FLOOR; the others follow in proportion."""


@dataclass
class Patience:
    """How long the Blender process may say nothing, by what is known of it."""

    longest: float = 0.0
    """Seconds that the longest picture took."""
    pictures: int = 0
    """Made by this process."""

    def finished(self, seconds: float) -> None:
        """Count a picture that took so long."""
        self.longest = max(self.longest, seconds)
        self.pictures += 1

    def limit(self, doing: str) -> float:
        """Return seconds of silence that are too long for what Blender does now."""
        if "kernels" in doing:
            floor = KERNELS
        else:
            floor = FLOOR if self.pictures else START
        return max(self.scaled(floor), min(TIMES * self.longest, LONGEST))

    def scaled(self, seconds: float) -> float:
        """Return seconds in the proportion that the environment asks for."""
        return seconds * _scale()


def _scale() -> float:
    try:
        given = float(os.environ.get(VARIABLE, ""))
    except ValueError:
        return 1.0
    return given / FLOOR if 0 < given < float("inf") else 1.0


# A temporary folder for Blender and its job; it is removed when they end, at the latest when the next one starts.

PREFIX, LOCK = "tmp-", ".lock"
UNLOCKED = 60.0
"""Seconds after which a folder that nobody ever locked counts as left behind."""


@contextmanager
def scratch_folder(home: Path) -> Iterator[Path]:
    """Yield a new folder below ``home``, and remove it afterwards; folders of processes that were killed go as well.

    Raises UserError if ``home`` is a link.
    """
    refuse_links(home)
    home.mkdir(parents=True, exist_ok=True)
    sweep(home)
    folder, lock = _locked_folder(home)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(lock)


def sweep(home: Path) -> None:
    """Remove the folders whose process has ended."""
    for folder in home.glob(f"{PREFIX}*"):
        if folder.is_symlink() or not folder.is_dir():
            continue
        if (folder / LOCK).exists():
            abandoned = files.is_abandoned(folder / LOCK)
        else:
            abandoned = _age(folder) > UNLOCKED
        if abandoned:
            shutil.rmtree(folder, ignore_errors=True)


def _locked_folder(home: Path) -> tuple[Path, int]:
    while True:
        folder = Path(tempfile.mkdtemp(prefix=PREFIX, dir=home))
        with suppress(FileNotFoundError):
            lock = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o644)
            with suppress(OSError):  # a disk without locks: what a kill leaves there stays
                files.try_lock(lock)
            if os.fstat(lock).st_nlink:
                return folder, lock
            os.close(lock)  # another process took the folder for a leftover before it was locked


def _age(folder: Path) -> float:
    try:
        return time.time() - folder.stat().st_mtime
    except OSError:
        return 0.0
