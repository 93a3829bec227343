"""Check of the disk before a night: it must have room for the pictures."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Collection
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path

from render.presets import Preset
from shared.contract.quantity import counted
from shared.stage.console import duration
from shared.stage.errors import UserError
from shared.stage.face import said
from shared.stage.files import file_hash
from shared.stage.paths import Out, out_root
from studio.night.plan.options import Options

# Progress of a film: its existing pictures, its missing ones, and the seconds that one takes.


FEWEST = 3
"""Pictures made in a run before their own pace counts, rather than that of the probe."""


@dataclass
class Frames:
    """Pictures of one film; all numbers count pictures, which a film may show several times."""

    name: str
    preset: Preset
    keys: frozenset[str] = frozenset()
    probed: float | None = None
    """Seconds a picture, as the last run or the probe measured it."""
    size: float = 0.0
    """Bytes of a picture, on average; 0 where none is there."""
    files: frozenset[str] = frozenset()
    """Names of the pictures in the folder as it was looked at last."""
    _contents: tuple[str, ...] = ()
    """Hashes of motion, parts and shot as they were read."""
    _seen: list[tuple[float, int]] = field(default_factory=list)
    """Moments (monotonic) at which pictures were first seen in this run, and how many there were then."""

    def read(self, show: str) -> bool:
        """Read from motion, parts and shot which pictures the film has; False if these are missing."""
        from render.film.inputs import read_film, refuse_missing

        out = Out(self.name)
        try:
            refuse_missing(out)
            contents = tuple(file_hash(path) for path in (out.motion, out.parts, out.shot))
            if contents == self._contents:
                return self._measured()
            from render.frames.frames import Pictures  # with numpy, which a run that has nothing to do never needs

            film = read_film(out, show, self.preset.aspect)
            pictures = Pictures(film, self.preset)
            self.keys = frozenset(pictures.key(frame) for frame in range(film.clock.frames))
        except (UserError, OSError, ValueError):
            return False
        self._contents = contents
        return self._measured()

    def _measured(self) -> bool:
        """Read the seconds a picture took in the last run, and look into the folder."""
        from render.frames.store import FrameStore

        timing = FrameStore(Out(self.name).frames(self.preset.name)).read_timing()
        self.probed = timing.cycles / timing.rendered if timing is not None else None
        self.look()
        return True

    @property
    def all(self) -> int:
        """Number of pictures of the film."""
        return len(self.keys)

    @property
    def existing(self) -> int:
        """Number of pictures of the film that exist."""
        return len({name.partition("-")[0] for name in self.files} & self.keys)

    def look(self) -> bool:
        """Look into the folder; return True if there is a new picture."""
        folder = Out(self.name).frames(self.preset.name)
        try:
            with os.scandir(folder) as entries:
                pictures = {entry.name: entry for entry in entries if entry.name.endswith(".png")}
                pictures = {name: entry for name, entry in pictures.items() if not name.startswith(".")}
                fresh = set(pictures) - self.files
                if fresh and not self.size:
                    self.size = sum(pictures[name].stat().st_size for name in fresh) / len(fresh)
        except OSError:
            pictures, fresh = {}, set()
        self.files = frozenset(pictures)
        if fresh:
            self._seen.append((time.monotonic(), self.existing))
        return bool(fresh)

    def begin(self) -> None:
        """Begin a run of the film: its pace is measured anew."""
        self._seen.clear()

    @property
    def each(self) -> float | None:
        """Seconds a picture; None while unknown."""
        if len(self._seen) >= FEWEST:
            (first, before), (last, after) = self._seen[0], self._seen[-1]
            if after > before:
                return (last - first) / (after - before)
        return self.probed

    @property
    def left(self) -> int:
        """Number of missing pictures."""
        return self.all - self.existing


# Forecast of the rest of the night: time, disk, energy, and the hour at which it ends.


START = 6.0
"""Seconds in which Blender is loaded and the scene is built, once a film."""
BYTES = 1.3
"""Bytes a pixel of a picture of the studio, until one was measured."""
LEAST, SURE = 0.3, 0.7
"""The same at the least; and the part of what was measured that the others of that film surely have."""
FILM = 0.1
"""Size of a film, of that of its pictures."""
RESERVE = 200e6
"""Bytes that stay free, as the stage of frames keeps them."""


@dataclass(frozen=True)
class Forecast:
    """Forecast of the unfinished films."""

    films: int
    pictures: int
    seconds: float | None
    """Seconds until the last one; None where no picture was measured."""
    unknown: int
    """Films among them of which no picture was measured; they count like the others on average."""
    unread: int
    """Films of which it is not known yet how many pictures they have."""
    bytes: float
    free: float | None
    """Bytes free on the disk; None where it cannot be asked."""
    least: float = 0.0
    """Bytes that the pictures surely have."""

    @property
    def fits(self) -> bool:
        """True if the disk has room."""
        return self.free is None or self.bytes + RESERVE <= self.free or not self.pictures

    @property
    def can_fit(self) -> bool:
        """True unless the disk surely has no room."""
        return self.free is None or self.least + RESERVE <= self.free or not self.pictures

    def ends(self, now: datetime) -> str:
        """Return the hour at which the night is over, with the day if it is another."""
        if self.seconds is None:
            return "at an hour that is not known yet"
        end = now + timedelta(seconds=self.seconds)
        return f"at {end:%H:%M}" if end.date() == now.date() else f"on {end:%A %d %B at %H:%M}"

    def words(self, now: datetime, watts: float | None = None) -> str:
        """Return the forecast in a sentence."""
        if not self.pictures and not self.unread:
            return "every frame is there"
        text = f"{counted(self.films, 'film')}, {counted(self.pictures, 'frame')} to render"
        if self.seconds is not None:
            text += f": {duration(self.seconds)}, finished {self.ends(now)}"
        if watts is not None and self.seconds is not None:
            text += f"; {energy(watts * self.seconds)} at {watts:g} W"
        free = "" if self.free is None else f" of {size(self.free)} free"
        text += f"; {size(self.bytes)} of disk{free}"
        if self.unknown:
            text += f"; {counted(self.unknown, 'film')} not measured, taken as the average of the others"
        if self.unread:
            text += f"; {counted(self.unread, 'film')} not counted, because their parts or motion are not there"
        return text


def forecast(films: Collection[Frames], unread: int, preset: Preset, disk: Path) -> Forecast:
    """Return the forecast over unfinished films; ``unread`` more have an unknown number of pictures."""
    left = [film for film in films if film.left]
    known = [film.each for film in left if film.each is not None]
    unknown = sum(film.each is None for film in left)
    pictures = sum(film.left for film in left)
    mean = sum(known) / len(known) if known else None
    seconds: float | None = None
    if mean is not None:
        seconds = sum(film.left * (mean if film.each is None else film.each) + START for film in left)
    elif not left:
        seconds = 0.0
    guess = BYTES * preset.width * preset.height
    needed = sum((film.left + FILM * film.all) * (film.size or guess) for film in left)
    least = sum(film.left * (SURE * film.size or LEAST * preset.width * preset.height) for film in left)
    try:
        free = float(shutil.disk_usage(next(p for p in (disk, *disk.parents) if p.exists())).free)
    except OSError:
        free = None
    return Forecast(len(left) + unread, pictures, seconds, unknown, unread, needed, free, least)


def size(count: float) -> str:
    """Return bytes in words: ``12 MB``, ``3.4 GB``."""
    if count < 1e9:
        return f"{count / 1e6:.0f} MB"
    return f"{count / 1e9:.1f} GB" if count < 100e9 else f"{count / 1e9:.0f} GB"


def energy(joules: float) -> str:
    """Return an energy in words, in watt-hours or kilowatt-hours."""
    hours = joules / 3600
    return f"{hours:.0f} Wh" if hours < 1000 else f"{hours / 1000:.1f} kWh"


def refuse_before_start(asked: Options, names: tuple[str, ...]) -> None:
    """Raise UserError if solved films of ``names`` surely need more than the disk has."""
    if asked.anyway:
        return
    films = [Frames(name, asked.preset) for name in names]
    known = [film for film in films if film.read(asked.show)]
    refuse(asked, forecast(known, len(films) - len(known), asked.preset, out_root()))


def refuse(asked: Options, forecast: Forecast) -> None:
    """Raise UserError with the numbers if the forecast surely exceeds the free space.

    ANYWAY skips the check.
    """
    if asked.anyway or forecast.can_fit or forecast.free is None:
        return
    raise UserError(
        f"{forecast.pictures} pictures of {asked.preset.name} are still to be made and need {size(forecast.least)} of "
        f"disk at the least; {out_root()} has {size(forecast.free)} free, of which {size(RESERVE)} stay free. "
        "Free some space, take a smaller preset, or set MBSD_OUT to another disk; "
        f"{said(anyway='')} begins all the same and makes films as long as there is room"
    )
