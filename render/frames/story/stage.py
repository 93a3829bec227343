"""``STORY=explain``: the film of a machine that explains it, its subtitles beside it."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from render.film.inputs import encoder_version, named, stage_key
from render.presets import Preset
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import sources_hash, whole_file, write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage

if TYPE_CHECKING:
    from render.frames.store import FrameStore
    from render.frames.story.telling import Telling

KIND = "explain"
PATIENCE = 600.0
"""Seconds for ffmpeg to write the chapters."""


def run(name: str, preset: Preset, show: str = "", loop: float = 0.0) -> None:
    """The stage: out/films/<mechanism>-<preset>-explain.mp4 and .srt; with ``loop`` a film of so many seconds that ends
    as it begins.

    Raises UserError, before a frame is rendered, for what the shot asks of the story and cannot be.
    """
    out = Out(name)
    stage = _stage(out, preset, show, loop)
    if stage.is_fresh():
        say("film", f"{out.name}: {preset}: {KIND}: nothing to do")
        return
    from render.film.story.subtitles import srt
    from render.frames import encode
    from render.frames.story.telling import telling_of

    encode.ffmpeg()  # reported now, not after the last frame
    telling = telling_of(out, preset, show, loop)
    story, (film, subtitles) = telling.story, stage.outputs
    say("film", f"{out.name}: {KIND}: {telling.said()}")
    rendered = _rendered(out, preset, telling)
    _encoded(out, preset, telling, rendered, film)
    write_bytes(subtitles, srt(story.captions).encode())
    stage.done()
    say(
        "film",
        f"{out.name}: {film}: {story.seconds:.1f} s, {story.fps} frames a second, {_size(film)}, subtitles beside it",
    )


def film_of(out: Out, preset: str, show: str = "", loop: float = 0.0) -> Path:
    """Where the film of a story is."""
    word = KIND if not loop else f"loop{loop:g}s"
    path = named(out.film(preset), show)
    return path.with_stem(f"{path.stem}-{word}")


def is_fresh(name: str, preset: Preset, show: str = "") -> bool:
    """Whether there is nothing to do. Raises UserError where motion, parts or shot are missing."""
    return _stage(Out(name), preset, show, 0.0).is_fresh()


def _stage(out: Out, preset: Preset, show: str, loop: float) -> Stage:
    film = film_of(out, preset.name, show, loop)
    room = Path(__file__).parents[2]
    sources = sources_hash(room / "report", *(room / f"{name}.py" for name in ("crank", "magnitudes", "shaking")))
    more = [path for path in (out.clearance,) if path.is_file()]
    key = stage_key(out, preset, encoder_version(), show, KIND, loop, sources, _described(out), *more)
    return Stage(out, film.stem.replace(out.name, "film", 1), key, [film, film.with_suffix(".srt")])


def _described(out: Out) -> str:
    from render.report import description

    return description(out.name)


@dataclass(frozen=True)
class Rendered:
    """What was rendered: the folder, and the file of each frame of the film."""

    store: FrameStore
    names: list[str]


def _rendered(out: Out, preset: Preset, telling: Telling) -> Rendered:
    """All pictures in a folder of their own, kept by what they show: what is there already is not rendered again."""
    from render.frames import frames
    from render.frames.store import FrameStore

    store, started = FrameStore(out.frames(f"{preset.name}-story"), (preset.width, preset.height)), time.perf_counter()
    sets = telling.pictures(preset)
    with store.locked():
        tally = frames.Tally()
        try:
            for _ in range(frames.ATTEMPTS):
                for pictures in sets:
                    frames.render(pictures, store, range(len(pictures.rows)), pictures.what, tally)
                if all(store.find(pictures.key(k)) for pictures in sets for k in range(len(pictures.rows))):
                    break
        finally:
            tally.write(store, preset, time.perf_counter() - started)
        by_row = {
            row: frames.picture_of(pictures, store, k) for pictures in sets for k, row in enumerate(pictures.rows)
        }
        store.prune(set(by_row.values()), spare=len(by_row))
    story = telling.story
    return Rendered(store, [by_row[telling.row(frame, preset)].name for frame in range(story.total)])


def _encoded(out: Out, preset: Preset, telling: Telling, rendered: Rendered, film: Path) -> None:
    """The film with its chapters, written whole."""
    from render.blender.scratch import scratch_folder
    from render.film.story.subtitles import chapters
    from render.frames import encode
    from shared.stage.paths import out_root

    story = telling.story
    with scratch_folder(out_root() / ".story") as scratch:
        bare, listing = scratch / film.name, scratch / "chapters.txt"
        encode.encode(_composed(out, preset, telling, rendered), story.total, preset, story.fps, bare)
        listing.write_text(chapters(story.chapters, telling.drawing.name))
        with whole_file(film) as target:
            _ffmpeg(film.name, "-i", str(bare), "-i", str(listing), "-map", "0:v:0", "-map_metadata", "1",
                    "-map_chapters", "1", "-c", "copy", "-movflags", "+faststart", "-fflags", "+bitexact",
                    str(target))  # fmt: skip


def _composed(out: Out, preset: Preset, telling: Telling, rendered: Rendered) -> Iterator[bytes]:
    """The frames of the film: pictures as they were rendered, with all that is laid over them."""
    import io

    from PIL import Image

    from render.frames.story.drawing import png

    kept: tuple[object, bytes] | None = None
    name, picture = "", None
    for frame, wanted in enumerate(rendered.names):
        if wanted != name or picture is None:
            content = rendered.store.read(wanted)
            if content is None:
                rendered.store.find(wanted.partition("-")[0])  # removes it, so that it is missed
                raise UserError(
                    f"{out.name}: frame {frame} ({wanted}) changed or went while the film was written; the same "
                    "command renders it again"
                )
            name, picture = wanted, Image.open(io.BytesIO(content)).convert("RGB")
        over = telling.story.over(frame)
        if kept is None or kept[0] != (name, over):
            kept = (name, over), png(telling.drawing.frame(picture, over))
        yield kept[1]


def _ffmpeg(name: str, *arguments: str) -> None:
    from render.frames.encode import ffmpeg

    command = [ffmpeg(), "-y", "-v", "error", *arguments]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        raise UserError(f"{name}: ffmpeg took longer than {PATIENCE:.0f} s; run it again") from None
    if done.returncode:
        said = (done.stderr.strip().splitlines() or [f"code {done.returncode}"])[-1]
        raise UserError(f"{name}: ffmpeg failed: {said}")


def _size(film: Path) -> str:
    return f"{film.stat().st_size / 1e6:.1f} MB"
