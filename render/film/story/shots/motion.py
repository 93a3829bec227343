"""Plain shots of the motion: the title, the run, and the last picture."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from render.film.camera import point
from render.film.framing import axes, in_studio
from render.film.story.frame import Caption, Over, Picture, Shot, shown_in
from render.film.story.ramps import Ramp, Warp, eased, warped
from render.film.story.scenery import Scenery, Stand, between, raised, turned
from render.film.story.shots.close_ups import busiest_joint, place_at
from shared.contract.quantity import figures

# The title: name and what it is, over the machine, which moves from the first picture on.

SECONDS, FADE = 2.4, 0.5


SMALL, CLOSER = 0.15, 0.27
"""Parts of the picture's area: a machine that takes less opens and ends closer, so that it takes about so much."""
CLOSEST, TRIES = 0.2, 61
"""Part of the distance at least, and distances that are tried."""


def opening(scenery: Scenery) -> Stand:
    """Return the stand of title and end: all of the machine, or of a small one the part where most happens."""
    whole = scenery.stand(strip=False)
    if scenery.share(scenery.stand()) >= SMALL or scenery.film.travel is not None:
        return whole
    place, stands = _kept(scenery, whole), []
    for part in np.linspace(1.0, CLOSEST, TRIES)[1:]:
        target = point(place + part * (np.array(whole.target) - place))
        near = raised(replace(whole, target=target, distance=part * whole.distance), scenery.up, scenery.top)
        if scenery.share(near) >= SMALL and not scenery.misses(near):
            stands.append(near)
    return min(stands, key=lambda near: abs(scenery.share(near) - CLOSER), default=whole)


def _kept(scenery: Scenery, whole: Stand) -> np.ndarray:
    """Return the point (3,) that keeps its place in the picture: a joint, or the end of the machine beside it."""
    rows = axes(whole.azimuth, whole.elevation)
    name, few = busiest_joint(scenery, stays=True), in_studio(scenery.film.subject.few, scenery.up) @ rows.T
    low, high = few.min(axis=0), few.max(axis=0)
    at = (low + high) / 2 if name is None else rows @ in_studio(np.array(place_at(scenery, name)), scenery.up)
    part = (at - low) / np.maximum(high - low, 1e-9)
    return np.where(part > 2 / 3, high, np.where(part < 1 / 3, low, at)) @ rows


def title(scenery: Scenery, after: Shot | None) -> Shot | None:
    """Return the title before a shot; None where no shot follows."""
    if after is None:
        return None
    seconds = scenery.whole(SECONDS)
    begin, rate = _run(scenery, seconds)
    stand = opening(scenery)

    def model(s: float) -> float:
        return begin + rate * s

    def over(s: float) -> Over:
        return Over(title=shown_in(s, -FADE, seconds - FADE, FADE))

    return Shot("title", scenery.say("title"), seconds, lambda s: scenery.picture(stand, model(s)), over, model)


def _run(scenery: Scenery, seconds: float) -> tuple[float, float]:
    """Return the time of the motion (s) some seconds of film before its poster, and its rate.

    Title and last shot have these pictures in common. A motion whose poster is at its start goes on from there.
    """
    clock = scenery.film.clock
    end = clock.moment(clock.frame_at(scenery.film.shot.poster)).time
    if clock.repeats or end - clock.start >= clock.rate * seconds:
        return end - clock.rate * seconds, clock.rate
    return clock.start, min(clock.rate, (clock.end - clock.start) / seconds)


# The machine in motion, three-quarter view: the camera swings past it, and the strip has its curves.

SWING = 9.0
"""Degrees of azimuth to each side."""
SHORT, STILL, LONG = 5.0, 7.5, 9.0
"""Seconds that the shot takes at least, where the camera stands and a second showing costs nothing, and at most."""
REST, OF = 0.2, 0.2
"""Seconds for which a motion that ends stands before it begins anew, and at most that part of it."""


def motion(scenery: Scenery) -> Shot:
    """Return whole turns at the rate of the loop film; a longer motion once, fast where it is dull."""
    clock = scenery.film.clock
    whole = clock.moving / scenery.fps
    each = scenery.whole(whole if clock.repeats else whole + min(REST, OF * whole))  # showings share their pictures
    showings = max(1, int(np.ceil((SHORT if scenery.turning else STILL) / each - 1e-9)))
    if whole > LONG:
        return _shot(scenery, _lively(scenery, clock.start, clock.end, LONG), LONG)
    if clock.repeats:
        rate = (clock.end - clock.start) / each
        return _shot(scenery, Ramp(clock.start, ((showings * each, rate, rate),)), showings * each)
    once = Ramp(clock.start, ((whole, clock.rate, clock.rate), (max(each - whole, 0.0), 0.0, 0.0)))
    return _shot(scenery, once, showings * each, each)


def _lively(scenery: Scenery, start: float, end: float, seconds: float) -> Warp:
    """Return a ramp that is slow where what the strip shows changes much, and where something happens."""
    time = np.asarray(scenery.film.motion.time)
    happens = np.zeros(len(time))
    for curve in scenery.curves:
        span = float(np.ptp(curve.values)) or 1.0
        steps = np.abs(np.gradient(curve.values / span, np.maximum.accumulate(time + 1e-12 * np.arange(len(time)))))
        happens += np.minimum(steps, np.quantile(steps, 0.98))
    width = 0.02 * (end - start)
    for reason in scenery.reasons[:1]:
        happens += happens.max() * np.exp(-0.5 * ((time - reason.start) / width) ** 2)
    return warped(scenery.film.motion.time, happens, start, end, seconds)


def _shot(scenery: Scenery, passes: Ramp | Warp, seconds: float, again: float = 0.0) -> Shot:
    """Return the shot of the motion; ``again``: seconds after which a motion that ends begins anew."""
    side = SWING if scenery.turning else 0.0
    first, last = (scenery.stand(azimuth) for azimuth in (-side, side))

    def model(s: float) -> float:
        return passes.time_at(s % again if again else s)

    def picture(s: float) -> Picture:
        return scenery.picture(between(first, last, eased(s / seconds)), model(s))

    text = _caption(scenery)

    def over(s: float) -> Over:
        shown = shown_in(s, 0.8, min(seconds, 5.0) - 0.4)
        rate = passes.shown_rate(s % again if again else s)
        return scenery.going(model(s), rate, caption=text, caption_shown=shown)

    captions = (Caption(0.8, min(seconds, 5.0) - 0.4, text),)
    return Shot("motion", scenery.say("motion"), seconds, picture, over, model, captions)


def _caption(scenery: Scenery) -> str:
    insight = scenery.of_motion
    span = scenery.film.clock.end - scenery.film.clock.start
    return scenery.say("lasts", time=f"{figures(span, 3)} s") if insight is None else scenery.sentence(insight)


# The last shot: the machine runs on to the pose of its poster, under its name.

MOVES = 1.6
"""Seconds in which the camera comes from aside."""


def last(scenery: Scenery) -> Shot:
    """Return the shot from a little aside into the three-quarter view, and to the moment of the poster."""
    clock, stop, runs = scenery.film.clock, scenery.moving(MOVES), scenery.whole(SECONDS)
    at, rate = _run(scenery, runs)
    end = opening(scenery)
    aside = [turned(scenery.stand(strip=False), -14.0, 3.0, farther) for farther in (1.1, 1.2, 1.3, 1.0)]
    begin = next((stand for stand in aside if not scenery.misses(stand)), aside[0])

    def model(s: float) -> float:
        return at + rate * (s - stop) if clock.repeats else max(at + rate * (s - stop), clock.start)

    def picture(s: float) -> Picture:
        return scenery.picture(between(begin, end, eased(s / stop)), model(s))

    def over(s: float) -> Over:
        return Over(ending=shown_in(s, stop - 0.4, 1e9, 0.5))

    return Shot("last", scenery.say("last"), stop + runs, picture, over, model)
