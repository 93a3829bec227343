"""The last shot: the machine comes to the pose of its poster and rests there, under its name."""

from __future__ import annotations

from render.film.story.cameras import between, turned
from render.film.story.frame import Over, Picture, Shot, shown_in
from render.film.story.ramp import eased, into
from render.film.story.scenery import Scenery

MOVES, SLOWS, RESTS = 0.8, 1.2, 2.4
"""Seconds: at the rate of the loop, slowing down, at rest."""


def last(scenery: Scenery) -> Shot:
    """From a little aside into the three-quarter view, and to the moment of the poster."""
    clock = scenery.film.clock
    goes, slows = scenery.moving(MOVES), scenery.moving(SLOWS)
    poster = clock.moment(clock.frame_at(scenery.film.shot.poster)).time
    ramp = into(poster, -1e300 if clock.repeats else clock.start, clock.rate, goes, slows)
    stop = goes + slows
    end = scenery.stand(strip=False)
    begin = turned(end, -14.0, 3.0, 1.1)

    def picture(s: float) -> Picture:
        return scenery.picture(between(begin, end, eased(s / stop)), ramp.at(min(s, stop)))

    def over(s: float) -> Over:
        return Over(ending=shown_in(s, stop - 0.4, 1e9, 0.5))

    return Shot("last", scenery.say("last"), stop + RESTS, picture, over, ramp.at)
