"""From a story to its film: pictures rendered, words laid over them, chapters; pictures that are there stay."""

from __future__ import annotations

import io
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from render.blender.process import scratch_folder
from render.film.story.story import Story
from render.film.story.words import chapters
from render.frames import encode, frames
from render.frames.encode import run_ffmpeg
from render.frames.store import FrameStore
from render.frames.story.drawing import Drawing, png
from render.frames.story.telling import Telling
from render.presets import Preset
from shared.stage.files import whole_file
from shared.stage.paths import Out, out_root

PATIENCE = 600.0
"""Seconds for ffmpeg to write the chapters."""
Page = tuple[str, Any]
"""Name of a picture, and the picture (RGB)."""


@dataclass(frozen=True)
class Rendered:
    """Rendered frames: the folder, and the file of each frame of the film."""

    mechanism: str
    store: FrameStore
    names: list[str]

    def pages(self) -> Iterator[Page]:
        """Yield the picture of each frame. Raises UserError for one that changed meanwhile."""
        from PIL import Image

        before, picture = "", None
        for name, content in self.store.contents(self.mechanism, self.names):
            if name != before or picture is None:
                before, picture = name, Image.open(io.BytesIO(content)).convert("RGB")
            yield name, picture


def rendered(out: Out, preset: Preset, telling: Telling) -> Rendered:
    """Return all pictures in a folder of their own, kept by what they show."""
    store, started = FrameStore(out.frames(f"{preset.name}-story"), (preset.width, preset.height)), time.perf_counter()
    sets = telling.pictures(preset)
    with store.locked():
        tally = frames.Tally()
        try:
            for _ in range(frames.ATTEMPTS):
                for pictures in sets:
                    frames.render(pictures, store, range(len(pictures.rows)), pictures.what, tally)
                if all(store.find(pictures.key(k)) for pictures in sets for k in range(len(pictures.rows))):
                    break  # nothing was damaged while the others were rendered
        finally:
            tally.write(store, preset, time.perf_counter() - started)
        by_row = {
            row: frames.picture_of(pictures, store, k) for pictures in sets for k, row in enumerate(pictures.rows)
        }
        store.prune(set(by_row.values()), spare=len(set(by_row.values())))
    total = telling.story.total
    return Rendered(out.name, store, [by_row[telling.row(frame, preset)].name for frame in range(total)])


def encoded(pages: Iterable[Page], story: Story, drawing: Drawing, preset: Preset, film: Path) -> None:
    """Write the film whole, with all that is laid over its pictures and with its chapters."""
    with scratch_folder(out_root() / ".blender") as scratch:
        bare, listing = scratch / film.name, scratch / "chapters.txt"
        encode.encode(_composed(pages, story, drawing), story.total, preset, story.fps, bare)
        listing.write_text(chapters(story.chapters, drawing.name), encoding="utf-8")
        with whole_file(film) as target:
            run_ffmpeg(film.name, "-i", str(bare), "-i", str(listing), "-map", "0:v:0", "-map_metadata", "1",
                       "-map_chapters", "1", "-c", "copy", "-movflags", "+faststart", "-fflags", "+bitexact",
                       str(target), patience=PATIENCE)  # fmt: skip


def _composed(pages: Iterable[Page], story: Story, drawing: Drawing) -> Iterator[bytes]:
    """Yield PNGs of the film; one that is as the one before is not drawn again."""
    kept: tuple[object, bytes] | None = None
    for frame, (name, picture) in enumerate(pages):
        over = story.over(frame)
        if kept is None or kept[0] != (name, over):
            kept = (name, over), png(drawing.frame(picture, over))
        yield kept[1]
