"""The film with a story: frames composed, encoded, with subtitles and sound."""

from __future__ import annotations

import io
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from render.blender.process import scratch_folder
from render.film.inputs import encoder_version, named, stage_key
from render.film.story.story import Story
from render.film.story.words import chapters
from render.frames import encode, frames
from render.frames.encode import run_ffmpeg
from render.frames.film import has_sound, sound_key, wav_of
from render.frames.store import FrameStore
from render.frames.story.drawing import Drawing, png
from render.frames.story.telling import Telling
from render.freshness import clearance_files
from render.presets import Preset
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import sources_hash, whole_file, write_bytes
from shared.stage.paths import Out, out_root
from shared.stage.stages import Stage, key_of

# From a story to its film: pictures rendered, words laid over them, chapters; what is there is not rendered again.

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
        """Yield the picture of each frame, read once while it stands. Raises UserError for one that changed
        meanwhile.
        """
        from PIL import Image

        name, picture = "", None
        for frame, wanted in enumerate(self.names):
            if wanted != name or picture is None:
                content = self.store.read(wanted)
                if content is None:
                    self.store.find(wanted.partition("-")[0])  # removes it, so that it is missed
                    raise UserError(
                        f"{self.mechanism}: frame {frame} ({wanted}) changed or went while the film was written; the "
                        "same command renders it again"
                    )
                name, picture = wanted, Image.open(io.BytesIO(content)).convert("RGB")
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
    """The film with all that is laid over its pictures and with its chapters, written whole."""
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


# ``STORY=explain``: the film of a machine that explains it, its subtitles beside it.

KIND = "explain"


def run(name: str, preset: Preset, show: str = "", loop: float = 0.0, sound: str = "") -> None:
    """The stage: out/films/<mechanism>-<preset>-explain.mp4, .srt and .wav, the last unless ``sound`` is "off".

    With ``loop`` it is a silent film of so many seconds that ends as it begins. Raises UserError, before a frame is
    rendered, for what the shot asks of the story and cannot be.
    """
    out = Out(name)
    heard = has_sound(sound) and not loop
    stage = _stage(out, preset, show, loop, heard)
    if stage.is_fresh():
        say("film", f"{out.name}: {preset}: {KIND}: nothing to do")
        return
    from render.film.story.words import srt
    from render.frames import encode
    from render.frames.story.telling import telling_of

    encode.ffmpeg()  # reported now, not after the last frame
    telling = telling_of(out, preset, show, loop)
    story, (film, subtitles, *_) = telling.story, stage.outputs
    say("film", f"{out.name}: {KIND}: {telling.said()}")
    silent = _silent_film(out, preset, show, loop, telling)
    if heard:
        _with_sound(silent, telling, preset, film)
    else:
        wav_of(film).unlink(missing_ok=True)
        write_bytes(film, silent.read_bytes())
    write_bytes(subtitles, srt(story.captions).encode())
    stage.done()
    say(
        "film",
        f"{out.name}: {film}: {story.seconds:.1f} s, {story.fps} frames a second, {_size(film)}, subtitles beside it",
    )


def _silent_film(out: Out, preset: Preset, show: str, loop: float, telling: Telling) -> Path:
    """Return the film without sound, in the folder of the frames; not made again where what decides it has not
    changed.
    """

    film = film_of(out, preset.name, show, loop)
    target = out.frames(f"{preset.name}-story") / film.name
    stage = Stage(out, film.stem.replace(out.name, "pictures", 1), _key(out, preset, show, loop), [target])
    if not stage.is_fresh():
        encoded(rendered(out, preset, telling).pages(), telling.story, telling.drawing, preset, target)
        stage.done()
    return target


def _with_sound(silent: Path, telling: Telling, preset: Preset, film: Path) -> None:
    from render.frames.encode import mux
    from render.sound.sound import sound_of, wav

    story, clock = telling.story, telling.film.clock
    waves = wav_of(film)
    write_bytes(waves, wav(sound_of(telling.film, story.time_map(clock.start, clock.end, clock.repeats))))
    mux(silent, waves, story.total, preset, story.fps, film)


def film_of(out: Out, preset: str, show: str = "", loop: float = 0.0) -> Path:
    """Return where the film of a story is."""
    word = KIND if not loop else f"loop{loop:g}s"
    path = named(out.film(preset), show)
    return path.with_stem(f"{path.stem}-{word}")


def is_fresh(name: str, preset: Preset, show: str = "", sound: str = "") -> bool:
    """Return True if there is nothing to do. Raises UserError where motion, parts or shot are missing."""
    return _stage(Out(name), preset, show, 0.0, has_sound(sound)).is_fresh()


def _stage(out: Out, preset: Preset, show: str, loop: float, heard: bool) -> Stage:
    film = film_of(out, preset.name, show, loop)
    key = key_of(_key(out, preset, show, loop), sound_key() if heard else "silent")
    outputs = [film, film.with_suffix(".srt")] + [wav_of(film)] * heard
    return Stage(out, film.stem.replace(out.name, "film", 1), key, outputs)


def _key(out: Out, preset: Preset, show: str, loop: float) -> str:
    """Return the key of the pictures and the words."""
    words = word_sources(), _described(out)
    return stage_key(out, preset, encoder_version(), show, KIND, loop, *words, *clearance_files(out))


def word_sources() -> str:
    """Return the hash of the sources of what stories say, beside those of pictures."""
    room = Path(__file__).parents[2]
    return sources_hash(room / "report", room / "magnitudes.py")


def _described(out: Out) -> str:
    from render.report import description

    return description(out.name)


def _size(film: Path) -> str:
    return f"{film.stat().st_size / 1e6:.1f} MB"
