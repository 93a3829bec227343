"""Jobs for Blender's process: what is asked, how long it may take, and the scratch folder."""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import msgspec

from render.film.scene import Scene, State
from shared.stage import locks
from shared.stage.paths import refuse_links

# What the parent asks of the Blender process, one JSON file; and what it answers, one JSON line at a time.


class Picture(msgspec.Struct, kw_only=True, frozen=True):
    """One picture to make: the state at an index of ``Job.states``, written whole into ``folder``.

    Its file is called ``<key>-<hash of key and bytes>.png``.
    """

    state: int
    folder: str
    key: str
    name: str
    """What messages call it: ``frame 12``."""


class Job(msgspec.Struct, kw_only=True, frozen=True):
    """Render ``pictures``, or save a .blend that plays all states."""

    scene: Scene
    states: list[State]
    """Consecutive frames; a blurred picture needs its neighbours."""
    pictures: list[Picture] = []
    waits: bool = False
    """Takes more pictures afterwards, a JSON line each on its standard input, until that closes."""
    blend: str | None = None
    width: int = 1280
    height: int = 720
    samples: int = 8
    motion_blur: bool = False
    flat: dict[str, tuple[float, float, float]] | None = None
    """Only these pieces (``body/piece``), as flat linear colours on black, sharp, without a view transform."""

    @property
    def drawn(self) -> bool:
        """True if the look draws lines instead of light."""
        return self.scene.studio.look.drawing is not None and self.flat is None


class Answer(msgspec.Struct, kw_only=True, frozen=True, omit_defaults=True):
    """One line from the Blender process: the device once, what it does, a line per picture; or an error."""

    device: str = ""
    doing: str = ""
    """What it is about to do, after the word "Blender"."""
    path: str = ""
    """A file that is whole."""
    key: str = ""
    """Key of the picture in that file."""
    cycles: float = 0.0
    """Seconds inside Blender's renderer for this picture."""
    error: str = ""


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
            abandoned = locks.is_abandoned(folder / LOCK)
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
                locks.take(lock)
            if os.fstat(lock).st_nlink:
                return folder, lock
            os.close(lock)  # another process took the folder for a leftover before it was locked


def _age(folder: Path) -> float:
    try:
        return time.time() - folder.stat().st_mtime
    except OSError:
        return 0.0
