"""``STORY=explain``: the film of a machine that explains it, its subtitles beside it."""

from __future__ import annotations

from pathlib import Path

from render.film.inputs import encoder_version, named, stage_key
from render.presets import Preset
from shared.stage.console import say
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage

KIND = "explain"


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
    from render.frames.story.composed import encoded, rendered
    from render.frames.story.telling import telling_of

    encode.ffmpeg()  # reported now, not after the last frame
    telling = telling_of(out, preset, show, loop)
    story, (film, subtitles) = telling.story, stage.outputs
    say("film", f"{out.name}: {KIND}: {telling.said()}")
    encoded(rendered(out, preset, telling).pages(), story, telling.drawing, preset, film)
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
    more = [path for path in (out.clearance,) if path.is_file()]
    key = stage_key(out, preset, encoder_version(), show, KIND, loop, word_sources(), _described(out), *more)
    return Stage(out, film.stem.replace(out.name, "film", 1), key, [film, film.with_suffix(".srt")])


def word_sources() -> str:
    """Hash of the sources of what stories say, beside those of pictures."""
    room = Path(__file__).parents[2]
    return sources_hash(room / "report", *(room / f"{name}.py" for name in ("crank", "magnitudes", "shaking")))


def _described(out: Out) -> str:
    from render.report import description

    return description(out.name)


def _size(film: Path) -> str:
    return f"{film.stat().st_size / 1e6:.1f} MB"
