"""Forecast of the rest of the night: time, disk, energy, and the hour at which it ends."""

from __future__ import annotations

import shutil
from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path

from render.presets import Preset
from shared.contract.quantity import counted
from shared.stage.console import duration
from studio.night.progress.frames import Frames

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
    """Until the last one; None where no picture was measured."""
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
