"""Progress of a film: its existing pictures, its missing ones, and the seconds that one takes."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, field

from render.presets import Preset
from shared.stage.errors import UserError
from shared.stage.files import file_hash
from shared.stage.paths import Out

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
