"""Two variants as two stories on one clock, and what is drawn over both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from render.film.film import Film
from render.film.inputs import read_film
from render.film.story.cameras import at_distance
from render.film.story.curves import Curve, curve_of, curves_of
from render.film.story.planned import scenery_of
from render.film.story.scenery import Scenery
from render.film.story.shots.beside import beside, differences, ramp_of
from render.film.story.shots.title import title
from render.film.story.story import Story
from render.film.story.words import plain, words_in
from render.frames.story.drawing import Drawing
from render.frames.story.strip import Strip
from render.frames.story.telling import Telling, refuse_long, shown_plain
from render.presets import Preset
from render.report.reasons import reasons
from shared.stage.paths import Out, variant_of

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
    """The stories of two variants, each in pictures of a ``half`` preset. Raises UserError for unfit wishes."""
    films = [_film(out, half) for out in outs]
    spans = (_span(films[0]), _span(films[1]))
    whys = [reasons(film.motion) for film in films]
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
    _on_one_scale(sceneries)
    tellings = []
    for film, scenery in zip(films, sceneries, strict=True):
        shot = beside(scenery, ramp, most[0] if most else None, names)
        shots = [made for made in (title(scenery, shot), shot) if made is not None]
        story = Story(film.motion.mechanism, films[0].shot.fps, scenery.step, shots, curves[0])
        tellings.append(Telling(film, None, story, drawing))
    refuse_long(outs[0].name, tellings[0].story, preset)
    return Pair((tellings[0], tellings[1]), drawing)


def _film(out: Out, half: Preset) -> Film:
    film = read_film(out, aspect=half.aspect)
    return Film(film.motion, film.parts, shown_plain(film.shot), film.folder, half.aspect)


def _first(curves: Sequence[Curve], name: str) -> list[Curve]:
    """The curves, that of a name first."""
    return sorted(curves, key=lambda curve: curve.name != name)


def _on_one_scale(sceneries: Sequence[Scenery]) -> None:
    """Let both cameras stand as far away as the farther one: the larger machine is larger in the picture, too."""
    stands = [scenery.stand() for scenery in sceneries]
    far = max(stand.distance for stand in stands)
    if far <= ALIKE * min(stand.distance for stand in stands) and len({stand.lens for stand in stands}) == 1:
        for scenery, stand in zip(sceneries, stands, strict=True):
            scenery.hold(at_distance(stand, far))


def _span(film: Film) -> float:
    """Seconds of the motion in one showing."""
    return film.clock.end - film.clock.start


def _common(films: Sequence[Film], curves: Sequence[Curve]) -> tuple[list[Curve], list[Curve]]:
    """Curves of both that have the same name and unit."""
    pairs = [(curve, curve_of(films[1].motion, curve.name)) for curve in curves]
    kept = [(a, b) for a, b in pairs if b is not None and a.unit == b.unit]
    return [a for a, _ in kept], [b for _, b in kept]


def _strip(preset: Preset, films: Sequence[Film], curves: tuple[list[Curve], list[Curve]], span: float) -> Strip | None:
    """The strip of both over all the time that is shown, each motion beginning anew where it repeats."""
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
    """What a variant is called; the mechanism itself, as it is."""
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
