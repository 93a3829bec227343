"""``STORY=compare``: a mechanism beside its variant, on one clock, with their curves over each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from render.film.inputs import encoder_version, refuse_missing, stage_key
from render.presets import Preset
from shared.stage.console import duration, say
from shared.stage.files import write_bytes
from shared.stage.paths import Out, compared, mechanism_name, owner_of, variant_of
from shared.stage.stages import Stage

if TYPE_CHECKING:
    from render.frames.story.composed import Rendered

KIND = "compare"


def run(name: str, preset: Preset) -> None:
    """The stage: out/films/<mechanism>-<preset>-compare.mp4 and .srt. Raises UserError for a mechanism of one kind."""
    outs = [Out(each) for each in both(name)]
    for out in outs:
        refuse_missing(out)
    stage = _stage(outs, preset)
    if stage.is_fresh():
        say("film", f"{outs[1].name}: {preset}: {KIND}: nothing to do")
        return
    from render.film.story.subtitles import srt
    from render.frames import encode
    from render.frames.story.composed import encoded, rendered
    from render.frames.story.pair import pair_of

    encode.ffmpeg()
    part = half(preset)
    pair = pair_of(outs, preset, part)
    story, (film, subtitles) = pair.tellings[0].story, stage.outputs
    counts = " and ".join(str(telling.count) for telling in pair.tellings)
    say("film", f"{outs[1].name}: {KIND}: {duration(story.seconds)}, {counts} pictures of {part.width}x{part.height}")
    made = [rendered(out, part, telling) for out, telling in zip(outs, pair.tellings, strict=True)]
    encoded(_beside(preset, made), story, pair.drawing, preset, film)
    write_bytes(subtitles, srt(story.captions).encode())
    stage.done()
    say("film", f"{outs[1].name}: {film}: {story.seconds:.1f} s, {story.fps} frames a second")


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


def _stage(outs: list[Out], preset: Preset) -> Stage:
    from render.frames.story.stage import word_sources

    film = outs[1].film(preset.name)
    film = film.with_stem(f"{film.stem}-{KIND}")
    keys = [stage_key(out, preset, encoder_version(), KIND, word_sources()) for out in outs]
    return Stage(outs[1], film.stem.replace(outs[1].name, "film", 1), "".join(keys), [film, film.with_suffix(".srt")])
