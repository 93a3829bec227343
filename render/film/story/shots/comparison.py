"""The shot of one of two variants side by side: what differs, and a ramp that both share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from render.film.story.frame import Caption, Over, Picture, Shot, shown_in
from render.film.story.ramps import Ramp
from render.film.story.scenery import Scenery
from render.film.story.story import Curve
from render.film.story.words import plain
from shared.contract.quantity import written

SECONDS, SLOWS, STANDS, RESTS = 12.0, 1.2, 4.0, 2.2
"""Seconds of film: in motion, slowing down, standing still, at rest at the end."""
SHORT = 6.0
ROWS = 600


@dataclass(frozen=True)
class Difference:
    """Where two curves of one name differ most."""

    time: float
    """s, from the start of both."""
    name: str
    unit: str
    values: tuple[float, float]


def differences(
    first: Sequence[Curve], second: Sequence[Curve], spans: tuple[float, float], repeats: tuple[bool, bool]
) -> list[Difference]:
    """Return differences of curves that both variants have, the largest first.

    It counts as a part of the larger curve. Where the shorter motion has no period it stands at its end.
    """
    times = np.linspace(0.0, max(spans), ROWS)
    out = []
    for a in first:
        b = next((curve for curve in second if curve.name == a.name and curve.unit == a.unit), None)
        if b is None:
            continue
        rows = [
            np.interp(times % span if anew else times, c.time - c.time[0], c.values)
            for c, span, anew in zip((a, b), spans, repeats, strict=True)
        ]
        k = int(np.abs(rows[0] - rows[1]).argmax())
        top = max(float(np.abs(row).max()) for row in rows)
        part = float(abs(rows[0][k] - rows[1][k])) / top if top else 0.0
        out.append((part, Difference(float(times[k]), a.name, a.unit, (float(rows[0][k]), float(rows[1][k])))))
    return [difference for part, difference in sorted(out, key=lambda row: -row[0]) if part > 1e-6]


def ramp_of(rate: float, span: float, at: float | None) -> Ramp:
    """Return a ramp from 0 over all of a ``span`` (s) at about a ``rate``, with a stop ``at`` a time."""
    seconds = min(max(span / rate, SHORT), SECONDS)
    rate = span / seconds
    if at is None:
        return Ramp(0.0, ((seconds, rate, rate), (RESTS, 0.0, 0.0)))
    slows = min(SLOWS, 2 * at / rate, 2 * (span - at) / rate)
    before, after = at / rate - slows / 2, (span - at) / rate - slows / 2
    return Ramp(
        0.0,
        (
            (before, rate, rate), (slows, rate, 0.0), (STANDS, 0.0, 0.0), (slows, 0.0, rate), (after, rate, rate),
            (RESTS, 0.0, 0.0),
        ),
    )  # fmt: skip


def comparison_shot(scenery: Scenery, ramp: Ramp, differs: Difference | None, names: tuple[str, str]) -> Shot:
    """Return the shot of one of the variants.

    Both have the same ``ramp``, whose times count from the start of each.
    """
    stand, start = scenery.stand(), scenery.film.clock.start
    seconds, text, shown = ramp.seconds, "", (0.0, 0.0)
    if differs is not None:
        text = scenery.say(
            "difference", curve=plain(differs.name), first=written(differs.values[0], differs.unit),
            second=written(differs.values[1], differs.unit), a=plain(names[0]), b=plain(names[1]),
        )  # fmt: skip
        stop = ramp.segments[0][0] + ramp.segments[1][0]
        shown = (stop - 0.2, stop + STANDS + 0.2)

    def picture(s: float) -> Picture:
        return scenery.picture(stand, start + ramp.time_at(s))

    def over(s: float) -> Over:
        return scenery.going(
            start + ramp.time_at(s), ramp.rate(s), caption=text, caption_shown=shown_in(s, *shown) if text else 0.0
        )

    captions = (Caption(*shown, text),) if text else ()
    return Shot("beside", scenery.say("compare"), seconds, picture, over, lambda s: start + ramp.time_at(s), captions)
