"""The film with a story: frames composed, encoded, with subtitles and sound."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from render import FRAME_SOURCES
from render.film.inputs import encoder_version, named, stage_key
from render.frames.film import finish, has_sound, sound_key, wav_of
from render.freshness import clearance_files
from render.presets import Preset
from shared.stage.console import say
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of

if TYPE_CHECKING:
    from render.frames.story.telling import Telling

# ``STORY=explain``: the film of a machine that explains it, its subtitles beside it.

KIND = "explain"


def run(name: str, preset: Preset, show: str = "", loop: float = 0.0, sound: str = "") -> None:
    """Make out/films/<mechanism>-<preset>-explain.mp4, .srt and .wav, the last unless ``sound`` is "off".

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
    finish(silent, partial(_sound, telling) if heard else None, story.total, preset, story.fps, film)
    write_bytes(subtitles, srt(story.captions).encode())
    stage.record()
    say(
        "film",
        f"{out.name}: {film}: {story.seconds:.1f} s, {story.fps} frames a second, {_size(film)}, subtitles beside it",
    )


def _silent_film(out: Out, preset: Preset, show: str, loop: float, telling: Telling) -> Path:
    """Return the film without sound, in the folder of the frames; not made again where what decides it has not
    changed.
    """
    from render.frames.story.composed import encoded, rendered

    film = film_of(out, preset.name, show, loop)
    target = out.frames(f"{preset.name}-story") / film.name
    stage = Stage(out, film.stem.replace(out.name, "pictures", 1), _key(out, preset, show, loop), [target])
    if not stage.is_fresh():
        encoded(rendered(out, preset, telling).pages(), telling.story, telling.drawing, preset, target)
        stage.record()
    return target


def _sound(telling: Telling) -> bytes:
    from render.sound.sound import sound_of_story, wav

    clock = telling.film.clock
    return wav(sound_of_story(telling.film, telling.story.time_map(clock.start, clock.end, clock.repeats)))


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
    return sources_hash(room / "report", *FRAME_SOURCES)


def _described(out: Out) -> str:
    from render.report import description

    return description(out.name)


def _size(film: Path) -> str:
    return f"{film.stat().st_size / 1e6:.1f} MB"
