"""Films of two variants side by side."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from render.film.film import Film
from render.film.inputs import encoder_version, read_film, refuse_missing, stage_key
from render.film.story.planned import scenery_of
from render.film.story.scenery import Scenery, at_distance
from render.film.story.shots.comparison import comparison_shot, differences, ramp_of
from render.film.story.shots.motion import title
from render.film.story.story import Curve, Story, curve_of, curves_of
from render.film.story.words import plain, words_in
from render.frames.film import finish, has_sound, sound_key, wav_of
from render.frames.story.drawing import Drawing
from render.frames.story.strip import Strip
from render.frames.story.telling import Telling, refuse_long, shown_plain
from render.insights.stops import stops
from render.presets import Preset
from shared.stage.console import duration, say
from shared.stage.files import write_bytes
from shared.stage.paths import Out, compared, mechanism_name, owner_of, variant_of
from shared.stage.stages import Stage, key_of

if TYPE_CHECKING:
    from render.frames.story.composed import Rendered
    from render.sound.sound import Heard


# Two variants as two stories on one clock, and what is drawn over both.

FIRST, SECOND = "#ff9a1a", "#f0f3f7"
"""Colours of the curves of the first and of the second."""
ALIKE = 2.5
"""Machines whose sizes differ by a larger factor are each as large as the picture lets them be."""
ROWS = 1500
"""Times of a curve of the strip."""


@dataclass(frozen=True)
class Pair:
    """Two stories of the same shots, and what is drawn over both."""

    tellings: tuple[Telling, Telling]
    drawing: Drawing


def pair_of(outs: Sequence[Out], preset: Preset, half: Preset) -> Pair:
    """Return the stories of two variants, each in pictures of a ``half`` preset. Raises UserError for unfit wishes."""
    films = [_film(out, half) for out in outs]
    spans = (_span(films[0]), _span(films[1]))
    whys = [stops(film.motion) for film in films]
    curves = _common(films, curves_of(films[0].motion, films[0].shot.story.curves, whys[0]))
    most = differences(*curves, spans, (films[0].clock.repeats, films[1].clock.repeats))
    if most:  # what the words are of is seen in pictures that have room for fewer curves, too
        curves = _first(curves[0], most[0].name), _first(curves[1], most[0].name)
    ramp = ramp_of(films[0].clock.rate, max(spans), most[0].time if most else None)
    names = (_name(outs[0], films[0]), _name(outs[1], films[1]))
    drawing = _drawing(outs[0], preset, names, _strip(preset, films, curves, max(spans)))
    sceneries = [
        replace(scenery_of(film, None, why, half), curves=curves[0]) for film, why in zip(films, whys, strict=True)
    ]
    put_on_one_scale(sceneries)
    tellings = []
    for film, scenery in zip(films, sceneries, strict=True):
        shot = comparison_shot(scenery, ramp, most[0] if most else None, names)
        shots = [made for made in (title(scenery, shot), shot) if made is not None]
        story = Story(film.motion.mechanism, films[0].shot.fps, scenery.step, shots, curves[0])
        tellings.append(Telling(film, None, story, drawing))
    refuse_long(outs[0].name, tellings[0].story, preset)
    return Pair((tellings[0], tellings[1]), drawing)


def _film(out: Out, half: Preset) -> Film:
    film = read_film(out, aspect=half.aspect)
    return Film(film.motion, film.parts, shown_plain(film.shot), film.folder, half.aspect)


def _first(curves: Sequence[Curve], name: str) -> list[Curve]:
    """Return the curves, that of a name first."""
    return sorted(curves, key=lambda curve: curve.name != name)


def put_on_one_scale(sceneries: Sequence[Scenery]) -> None:
    """Let both cameras stand as far away as the farther one: the larger machine is larger in the picture, too."""
    stands = [scenery.stand() for scenery in sceneries]
    far = max(stand.distance for stand in stands)
    if far <= ALIKE * min(stand.distance for stand in stands) and len({stand.lens for stand in stands}) == 1:
        for scenery, stand in zip(sceneries, stands, strict=True):
            scenery.hold(at_distance(stand, far))


def _span(film: Film) -> float:
    """Return seconds of the motion in one showing."""
    return film.clock.end - film.clock.start


def _common(films: Sequence[Film], curves: Sequence[Curve]) -> tuple[list[Curve], list[Curve]]:
    """Return curves of both that have the same name and unit."""
    pairs = [(curve, curve_of(films[1].motion, curve.name)) for curve in curves]
    kept = [(a, b) for a, b in pairs if b is not None and a.unit == b.unit]
    return [a for a, _ in kept], [b for _, b in kept]


def _strip(preset: Preset, films: Sequence[Film], curves: tuple[list[Curve], list[Curve]], span: float) -> Strip | None:
    """Return the strip of both over all the time that is shown, each motion beginning anew where it repeats."""
    if not curves[0]:
        return None
    start = films[0].clock.start
    times = np.linspace(0.0, span, ROWS)

    def laid(film: Film, curve: Curve, colour: str) -> Curve:
        inside = times % _span(film) if film.clock.repeats else np.minimum(times, _span(film))
        values = np.interp(curve.time[0] + inside, curve.time, curve.values)
        return Curve(curve.name, curve.unit, colour, start + times, values)

    ours = [laid(films[0], curve, FIRST) for curve in curves[0]]
    theirs = [laid(films[1], curve, SECOND) for curve in curves[1]]
    return Strip(ours, (), start, start + span, False, preset.width, preset.height, theirs)


def _name(out: Out, film: Film) -> str:
    """Return the name of a variant; "as it is" for the mechanism itself."""
    return plain(variant_of(out.name) or "") or words_in(film.shot.story.language, out.name)("usual")


def _drawing(out: Out, preset: Preset, names: tuple[str, str], strip: Strip | None) -> Drawing:
    words = plain(out.name)
    side = preset.width >= preset.height
    heads = ((False, 0.0, names[0], FIRST), (side, 0.0 if side else 0.5, names[1], SECOND))
    said = (f"{names[0][:1].upper()}{names[0][1:]} / {names[1]}",)
    return Drawing(
        wide=preset.width, high=preset.height, name=words[:1].upper() + words[1:], said=said, facts="", strip=strip,
        heads=heads,
    )  # fmt: skip


# ``STORY=compare``: a mechanism beside its variant, on one clock, with their curves over each other.

KIND = "compare"


def run(name: str, preset: Preset, sound: str = "") -> None:
    """Make out/films/<mechanism>-<preset>-compare.mp4, .srt and .wav, the last unless ``sound`` is "off".

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
    from render.film.story.words import srt
    from render.frames import encode

    encode.ffmpeg()
    part = half(preset)
    pair = pair_of(outs, preset, part)
    story, (film, subtitles, *_) = pair.tellings[0].story, stage.outputs
    counts = " and ".join(str(telling.count) for telling in pair.tellings)
    say("film", f"{outs[1].name}: {KIND}: {duration(story.seconds)}, {counts} pictures of {part.width}x{part.height}")
    silent = _silent_film(outs, preset, pair, film)
    finish(silent, partial(_sound, pair, preset) if heard else None, story.total, preset, story.fps, film)
    write_bytes(subtitles, srt(story.captions).encode())
    stage.record()
    words = "with the sound of both" if heard else "silent"
    say("film", f"{outs[1].name}: {film}: {story.seconds:.1f} s, {story.fps} frames a second, {words}")


def _silent_film(outs: list[Out], preset: Preset, pair: Pair, film: Path) -> Path:
    """Return the film without sound, in the folder of the second's frames; not made again where nothing has changed."""
    from render.frames.story.composed import encoded, rendered

    part = half(preset)
    target = outs[1].frames(f"{part.name}-story") / film.name
    stage = Stage(outs[1], film.stem.replace(outs[1].name, "pictures", 1), _key(outs, preset), [target])
    if not stage.is_fresh():
        made = [rendered(out, part, telling) for out, telling in zip(outs, pair.tellings, strict=True)]
        encoded(side_by_side(preset, made), pair.tellings[0].story, pair.drawing, preset, target)
        stage.record()
    return target


def _sound(pair: Pair, preset: Preset) -> bytes:
    from render.sound.sound import sound_of_all, wav

    return wav(sound_of_all(heard_of(pair, preset)))


def heard_of(pair: Pair, preset: Preset) -> list[Heard]:
    """Return both machines, each on its own clock and where its picture is: over each other they are heard in the
    middle.
    """
    from render.sound.sound import Heard

    windows = ((-1.0, 0.0), (0.0, 1.0)) if preset.width >= preset.height else ((-1.0, 1.0), (-1.0, 1.0))
    heard = []
    for telling, within in zip(pair.tellings, windows, strict=True):
        clock = telling.film.clock
        heard.append(Heard(telling.film, telling.story.time_map(clock.start, clock.end, clock.repeats), within))
    return heard


def both(name: str) -> tuple[str, str]:
    """Return the mechanism and the variant that a name means: its own, or the first. Raises UserError without
    variants.
    """
    owner, variant = owner_of(name), variant_of(name) or compared(name)[0]
    return mechanism_name(owner), f"{owner}-{variant}"


def half(preset: Preset) -> Preset:
    """Return the preset of one of two pictures: beside each other, or over each other where the picture is tall."""
    wide, high = preset.width, preset.height
    wide, high = (wide // 2, high) if wide >= high else (wide, high // 2)
    return replace(preset, name=f"{preset.name}-half", width=wide, height=high)


def side_by_side(preset: Preset, made: Sequence[Rendered]) -> Iterator[tuple[str, Any]]:
    """Yield the pictures of both variants in one, with the names of both; one that stands is pasted once."""
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
    """Return the key of the pictures and the words."""
    from render.frames.story.stage import word_sources

    return key_of(*(stage_key(out, preset, encoder_version(), KIND, word_sources()) for out in outs))
