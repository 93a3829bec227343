"""The machine in motion, three-quarter view: the camera swings past it, and the strip has its curves."""

from __future__ import annotations

import numpy as np

from render.film.story.cameras import between
from render.film.story.frame import Caption, Over, Picture, Shot, shown_in
from render.film.story.ramp import Ramp, Warp, eased, warped
from render.film.story.scenery import Scenery
from shared.contract.quantity import figures

SWING = 9.0
"""Degrees of azimuth to each side."""
SHORT, LONG = 5.0, 9.0
"""Seconds that the shot takes at least and at most, holds left out."""
REST = 0.7
"""Seconds for which a motion that ends stands before it begins anew."""


def motion(scenery: Scenery) -> Shot:
    """Whole turns at the rate of the loop film; a longer motion once, fast through what is dull."""
    clock = scenery.film.clock
    whole = clock.moving / scenery.fps
    showings = max(1, int(np.ceil(SHORT / (whole if clock.repeats else whole + REST) - 1e-9)))
    if whole > LONG:
        return _shot(scenery, _lively(scenery, clock.start, clock.end, LONG), LONG)
    if clock.repeats:
        turns = Ramp(clock.start, ((showings * whole, clock.rate, clock.rate),))
        return _shot(scenery, turns, turns.seconds)
    once = Ramp(clock.start, ((whole, clock.rate, clock.rate), (REST, 0.0, 0.0)))
    return _shot(scenery, once, showings * once.seconds, once.seconds)


def _lively(scenery: Scenery, start: float, end: float, seconds: float) -> Warp:
    """Slow where what the strip shows changes much, and where something happens."""
    time = np.asarray(scenery.film.motion.time)
    happens = np.zeros(len(time))
    for curve in scenery.curves:
        span = float(np.ptp(curve.values)) or 1.0
        steps = np.abs(np.gradient(curve.values / span, np.maximum.accumulate(time + 1e-12 * np.arange(len(time)))))
        happens += np.minimum(steps, np.quantile(steps, 0.98))
    width = 0.02 * (end - start)
    for reason in scenery.reasons[:1]:
        happens += happens.max() * np.exp(-0.5 * ((time - reason.time) / width) ** 2)
    return warped(scenery.film.motion.time, happens, start, end, seconds)


def _shot(scenery: Scenery, passes: Ramp | Warp, seconds: float, again: float = 0.0) -> Shot:
    """``again``: after so many seconds a motion that ends begins anew."""
    side = SWING if scenery.turning else 0.0
    first, last = (scenery.stand(azimuth) for azimuth in (-side, side))

    def model(s: float) -> float:
        return passes.at(s % again if again else s)

    def picture(s: float) -> Picture:
        return scenery.picture(between(first, last, eased(s / seconds)), model(s))

    text = _caption(scenery)

    def over(s: float) -> Over:
        shown = shown_in(s, 0.8, min(seconds, 5.0) - 0.4)
        rate = passes.rate(s % again if again else s)
        return scenery.going(model(s), rate, caption=text, caption_shown=shown)

    captions = (Caption(0.8, min(seconds, 5.0) - 0.4, text),)
    return Shot("motion", scenery.say("motion"), seconds, picture, over, model, captions)


def _caption(scenery: Scenery) -> str:
    clock, say = scenery.film.clock, scenery.say
    span = clock.end - clock.start
    return say("repeats" if clock.repeats else "lasts", time=f"{figures(span, 3)} s")
