"""``STORY=compare``: a mechanism beside its variant, on one clock, with their curves over each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from render.film.inputs import encoder_version, refuse_missing, stage_key
from render.frames.film import has_sound, sound_key, wav_of
from render.presets import Preset
from shared.stage.console import duration, say
from shared.stage.files import write_bytes
from shared.stage.paths import Out, compared, mechanism_name, owner_of, variant_of
from shared.stage.stages import Stage, key_of

if TYPE_CHECKING:
    from render.frames.story.composed import Rendered
    from render.frames.story.pair import Pair
    from render.sound.together import Heard

KIND = "compare"


def run(name: str, preset: Preset, sound: str = "") -> None:
    """The stage: out/films/<mechanism>-<preset>-compare.mp4, .srt and .wav, the last unless ``sound`` is "off".

    Raises UserError for a mechanism of one kind.
    """
    outs = [Out(each) for each in both(name)]
    for out in outs:
        refuse_missing(out)
    heard = has_sound(sound)
    stage = _stage(outs, preset, heard)
    if stage.is_fresh():
        say("film", f"{outs[1].name}: {preset}: {KIND}: nothing to do")
        return
    from render.film.story.subtitles import srt
    from render.frames import encode
    from render.frames.story.pair import pair_of

    encode.ffmpeg()
    part = half(preset)
    pair = pair_of(outs, preset, part)
    story, (film, subtitles, *_) = pair.tellings[0].story, stage.outputs
    counts = " and ".join(str(telling.count) for telling in pair.tellings)
    say("film", f"{outs[1].name}: {KIND}: {duration(story.seconds)}, {counts} pictures of {part.width}x{part.height}")
    silent = _silent_film(outs, preset, pair, film)
    if heard:
        _with_sound(silent, pair, preset, film)
    else:
        wav_of(film).unlink(missing_ok=True)
        write_bytes(film, silent.read_bytes())
    write_bytes(subtitles, srt(story.captions).encode())
    stage.done()
    words = "with the sound of both" if heard else "silent"
    say("film", f"{outs[1].name}: {film}: {story.seconds:.1f} s, {story.fps} frames a second, {words}")


def _silent_film(outs: list[Out], preset: Preset, pair: Pair, film: Path) -> Path:
    """The film without sound, in the folder of the second's frames; not made again where nothing has changed."""
    from render.frames.story.composed import encoded, rendered

    part = half(preset)
    target = outs[1].frames(f"{part.name}-story") / film.name
    stage = Stage(outs[1], film.stem.replace(outs[1].name, "pictures", 1), _key(outs, preset), [target])
    if not stage.is_fresh():
        made = [rendered(out, part, telling) for out, telling in zip(outs, pair.tellings, strict=True)]
        encoded(_beside(preset, made), pair.tellings[0].story, pair.drawing, preset, target)
        stage.done()
    return target


def _with_sound(silent: Path, pair: Pair, preset: Preset, film: Path) -> None:
    from render.frames.muxing import mux
    from render.sound.together import sound_of_all
    from render.sound.wave_file import wav

    story, waves = pair.tellings[0].story, wav_of(film)
    write_bytes(waves, wav(sound_of_all(heard_of(pair, preset))))
    mux(silent, waves, story.total, preset, story.fps, film)


def heard_of(pair: Pair, preset: Preset) -> list[Heard]:
    """Both machines, each on its own clock and where its picture is: over each other they are heard in the middle."""
    from render.sound.together import Heard

    windows = ((-1.0, 0.0), (0.0, 1.0)) if preset.width >= preset.height else ((-1.0, 1.0), (-1.0, 1.0))
    heard = []
    for telling, within in zip(pair.tellings, windows, strict=True):
        clock = telling.film.clock
        heard.append(Heard(telling.film, telling.story.time_map(clock.start, clock.end, clock.repeats), within))
    return heard


def both(name: str) -> tuple[str, str]:
    """The mechanism and the variant that a name means: its own, or the first. Raises UserError without variants."""
    owner, variant = owner_of(name), variant_of(name) or compared(name)[0]
    return mechanism_name(owner), f"{owner}-{variant}"


def half(preset: Preset) -> Preset:
    """The preset of one of two pictures: beside each other, or over each other where the picture is tall."""
    wide, high = preset.width, preset.height
    wide, high = (wide // 2, high) if wide >= high else (wide, high // 2)
    return replace(preset, name=f"{preset.name}-half", width=wide, height=high)


def _beside(preset: Preset, made: Sequence[Rendered]) -> Iterator[tuple[str, Any]]:
    from PIL import Image

    kept: tuple[str, Any] | None = None
    for (a, first), (b, second) in zip(made[0].pages(), made[1].pages(), strict=True):
        if kept is None or kept[0] != a + b:
            page = Image.new("RGB", (preset.width, preset.height), (9, 12, 17))
            page.paste(first, (0, 0))
            away = (preset.width - second.width, preset.height - second.height)
            page.paste(second, away)
            gap = max(1, round(min(page.size) / 240))
            line = (0, away[1] - gap, page.width, away[1]) if away[1] else (away[0] - gap, 0, away[0], page.height)
            page.paste((9, 12, 17), line)
            kept = a + b, page
        yield kept


def _stage(outs: list[Out], preset: Preset, heard: bool) -> Stage:
    film = outs[1].film(preset.name)
    film = film.with_stem(f"{film.stem}-{KIND}")
    key = key_of(_key(outs, preset), sound_key() if heard else "silent")
    outputs = [film, film.with_suffix(".srt")] + [wav_of(film)] * heard
    return Stage(outs[1], film.stem.replace(outs[1].name, "film", 1), key, outputs)


def _key(outs: list[Out], preset: Preset) -> str:
    """What decides the pictures and the words."""
    from render.frames.story.stage import word_sources

    return key_of(*(stage_key(out, preset, encoder_version(), KIND, word_sources()) for out in outs))
