"""The folder of one preset's frames: pictures by key, the film's index, and the timing of the last run.

out/<mechanism>/frames/<preset>/<key>.png, frames.json, timing.json
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Literal

import msgspec

from shared import jsonfile
from shared.errors import UserError
from shared.paths import refuse_links


class FrameIndex(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """frames.json: which picture each frame of the film shows."""

    schema: Literal["mbsd.frames"] = "mbsd.frames"
    schema_version: Literal[1] = 1
    mechanism: str
    preset: str
    width: int
    height: int
    fps: int
    frames: list[str]
    """Key of every frame in order; the picture is ``<key>.png`` beside this file."""


class Timing(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """timing.json: how long the last run of some length took. Seconds."""

    schema: Literal["mbsd.timing"] = "mbsd.timing"
    schema_version: Literal[1] = 1
    preset: str
    device: str
    work: int
    """Samples in one picture."""
    rendered: int
    """Pictures made in that run."""
    wall: float
    """The whole stage, from its start to its end."""
    cycles: float
    """Inside Blender's renderer."""
    overhead: float
    """wall / cycles."""


class FrameStore:
    """The pictures of one preset."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.index = folder / "frames.json"
        self.timing = folder / "timing.json"

    def path(self, key: str) -> Path:
        """Where the picture with this key is, or will be."""
        return self.folder / f"{key}.png"

    def has(self, key: str, width: int, height: int) -> bool:
        """Whether the picture is there, whole; a damaged one is removed."""
        path = self.path(key)
        if not path.exists():
            return False
        if is_whole(path, width, height):
            return True
        path.unlink()
        return False

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Hold the folder for one process; raises UserError if another renders into it. Sweeps up unfinished files."""
        refuse_links(self.folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        handle = os.open(self.folder / ".lock", os.O_RDWR | os.O_CREAT, 0o644)
        try:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise UserError(f"another process renders into {self.folder}; wait for it or stop it") from None
            self._sweep()
            yield
        finally:
            self._sweep()
            os.close(handle)

    def prune(self, used: Collection[str], spare: int) -> int:
        """Remove the oldest pictures the film no longer uses, but keep ``spare`` of them; returns how many went."""
        unused = [path for path in self.folder.glob("*.png") if path.stem not in used]
        unused.sort(key=lambda path: (path.stat().st_mtime, path.name), reverse=True)
        for path in unused[spare:]:
            path.unlink()
        return len(unused[spare:])

    def read_timing(self) -> Timing | None:
        """The timing of the last run, if there was one."""
        try:
            return jsonfile.read(self.timing, Timing)
        except UserError:
            return None

    def _sweep(self) -> None:
        for path in self.folder.glob(".*.part.png"):
            path.unlink(missing_ok=True)


def is_whole(path: Path, width: int, height: int) -> bool:
    """Whether a PNG decodes to its last row at this size."""
    from PIL import Image

    try:
        with Image.open(path) as picture:
            picture.load()
            return picture.size == (width, height)
    except (OSError, SyntaxError, ValueError):
        return False
