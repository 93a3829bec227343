"""The folder of one preset's frames: pictures by key, the film's index, and the timing of the last run.

out/<mechanism>/frames/<preset>/<key>-<hash>.png, frames.json, timing.json, plates/. The name of a picture says what it
shows and which bytes it has, so one that was damaged, or swapped for another, is known without a list beside it.
"""

from __future__ import annotations

import os
import time
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Annotated, Literal

import msgspec

from render.blender.job import Plate
from render.blender.picture_file import fault_of_chunks, is_as_named
from shared.stage import files, jsonfile
from shared.stage.console import say
from shared.stage.errors import Busy, UserError
from shared.stage.files import refusal, write_bytes
from shared.stage.paths import refuse_links

WAIT = 10.0
"""Seconds to wait for another process that has the folder: one that was stopped needs a moment to clean up."""
Count = Annotated[int, msgspec.Meta(ge=1)]
Seconds = Annotated[float, msgspec.Meta(ge=0, le=1e9)]


class FrameIndex(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """frames.json: which picture each frame of the film shows."""

    schema: Literal["mbsd.frames"] = "mbsd.frames"
    schema_version: Literal[2] = 2
    mechanism: str
    preset: str
    width: int
    height: int
    fps: int
    frames: list[str]
    """File name of every frame's picture in order, beside this file."""


class Timing(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """timing.json: how long the last run of some length took. Seconds."""

    schema: Literal["mbsd.timing"] = "mbsd.timing"
    schema_version: Literal[1] = 1
    preset: str
    device: str
    work: Count
    """Samples in one picture."""
    rendered: Count
    """Pictures made in that run."""
    wall: Seconds
    """The whole stage, from its start to its end."""
    cycles: Seconds
    """Inside Blender's renderer."""
    overhead: Annotated[float, msgspec.Meta(ge=0)]
    """wall / cycles."""


class FrameStore:
    """The pictures of one preset; where ``size`` (width, height in pixels) is given, PNGs of that size alone count.

    A name tells that nothing has changed a picture since it was made, not that what made it was right.
    """

    def __init__(self, folder: Path, size: tuple[int, int] | None = None) -> None:
        self.folder, self.size = folder, size
        self.index = folder / "frames.json"
        self.timing = folder / "timing.json"
        self.plates = folder / "plates"

    def find(self, key: str) -> Path | None:
        """Return the picture with this key, if it is there and has the bytes that its name tells; a damaged one is
        removed.
        """
        for path in sorted(self.folder.glob(f"{key}-*.png")):
            try:
                if self._is_picture(path, path.read_bytes()):
                    return path
            except FileNotFoundError:
                continue
            except OSError as error:
                raise UserError(refusal(path, error, "read")) from error
            say("frames", f"{path.name} is not the picture that was rendered any more; it is rendered again")
            self._remove(path)
        return None

    def read(self, name: str) -> bytes | None:
        """Return the bytes of the picture with this file name, if they are those that were rendered; else None."""
        path = self.folder / name
        with suppress(OSError):
            content = path.read_bytes()
            if self._is_picture(path, content):
                return content
        return None

    def contents(self, mechanism: str, names: Iterable[str]) -> Iterator[tuple[str, bytes]]:
        """Yield name and bytes of the pictures of a film's frames in order, each read once while it stands.

        The bytes are compared with the hash in the name. Raises UserError for a picture that changed meanwhile.
        """
        before, content = "", None
        for frame, name in enumerate(names):
            if name != before or content is None:
                before, content = name, self.read(name)
            if content is None:
                self.find(name.partition("-")[0])  # removes it, so that it is missed
                raise UserError(
                    f"{mechanism}: frame {frame} ({name}) changed or went while the film was written; the same command "
                    "renders it again"
                )
            yield name, content

    def keep(self, name: str, content: bytes) -> None:
        """Keep a picture that was made elsewhere. Raises UserError if these are not its bytes, or the disk is full."""
        path = self.folder / name
        if not self._is_picture(path, content):
            raise UserError(f"{path.name} came damaged from where it was rendered; run the same command again")
        write_bytes(path, content)

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Hold the folder for one process, after a short wait for another; sweeps up unfinished files.

        Raises UserError if another process goes on rendering into the folder, or if it cannot be written.
        """
        refuse_links(self.folder)
        lock = self.folder / ".lock"
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            if lock.is_dir():
                lock.rmdir()
            handle = os.open(lock, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)
        except OSError as error:
            raise UserError(refusal(lock, error)) from error
        try:
            self._lock(handle)
            self._sweep()
            yield
        finally:
            with suppress(UserError):
                self._sweep()
            os.close(handle)

    def _lock(self, handle: int) -> None:
        end, announced = time.monotonic() + WAIT, False
        try:
            while not files.try_lock(handle):
                if time.monotonic() >= end:
                    raise Busy(f"another process renders into {self.folder}; wait for it or stop it")
                if not announced:
                    say("frames", f"another process has {self.folder}; waiting {WAIT:.0f} s for it")
                    announced = True
                time.sleep(0.1)
        except OSError as error:
            raise UserError(refusal(self.folder / ".lock", error, "lock")) from error

    def prune(self, used: Collection[Path], spare: int) -> int:
        """Remove the oldest pictures the film no longer uses, but keep ``spare`` of them; returns how many went."""
        unused = [path for path in self.folder.glob("*.png") if path not in used]
        unused.sort(key=lambda path: (path.stat().st_mtime, path.name), reverse=True)
        for path in unused[spare:]:
            self._remove(path)
        return len(unused[spare:])

    def prune_plates(self, used: Collection[Plate]) -> None:
        """Remove plates, and what their trials found, that the film does not use."""
        keys = {key for plate in used for key in (plate.key, plate.trial)}
        for path in self.plates.glob("*.*"):
            if path.stem.partition("-")[0] not in keys:
                self._remove(path)

    def read_timing(self) -> Timing | None:
        """Return the timing of the last run, if there was one."""
        try:
            return jsonfile.read(self.timing, Timing)
        except UserError:
            return None

    def _is_picture(self, path: Path, content: bytes) -> bool:
        return is_as_named(path, content) and (self.size is None or fault_of_chunks(content, *self.size) is None)

    def _sweep(self) -> None:
        for path in self.folder.glob(".*.part.png"):
            self._remove(path)

    def _remove(self, path: Path) -> None:
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise UserError(refusal(path, error, "remove")) from error
