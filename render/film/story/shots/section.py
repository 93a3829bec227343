"""The section: the machine in motion as its shot cuts it open; the camera walks a little to the side of the cut."""

from __future__ import annotations

import math

from render.film.camera import angles
from render.film.film import Film
from render.film.story.cameras import between
from render.film.story.frame import Caption, Over, Picture, Shot, shown_in
from render.film.story.ramp import Ramp, eased
from render.film.story.scenery import Scenery
from shared.contract.shot import Section
from shared.stage.errors import UserError

SECONDS, MOVES = 4.8, 4.0
"""Seconds of the shot, and of its move."""
BEGIN, END = (-12.0, 4.0), (8.0, -2.0)
"""Azimuth and elevation (degrees) beside those of the cut film, from which its faces are seen; what is cut from the
left is seen the other way round."""


def section(scenery: Scenery) -> Shot | None:
    """The section; None of a shot that cuts nothing open. Raises UserError where it is asked for all the same."""
    if scenery.cut is None:
        if "section" in (scenery.wishes.shots or ()):
            raise UserError(
                f"{scenery.film.motion.mechanism}: shot.story.shots has a section, and shot.section cuts nothing open; "
                "give the shot one, such as section=0.4"
            )
        return None
    clock, move = scenery.film.clock, scenery.moving(MOVES)
    begin = clock.start if clock.repeats else max(clock.start, _busy(scenery) - clock.rate * move / 2)
    ramp = Ramp(begin, ((0.75 * move, clock.rate, clock.rate), (0.25 * move, clock.rate, 0.0)))
    side, turn = _side(scenery), _turn(scenery, scenery.cut)
    first, last = (scenery.stand(turn + side * azimuth, high, strip=False) for azimuth, high in (BEGIN, END))

    def picture(s: float) -> Picture:
        stand = between(first, last, eased(s / move))
        return scenery.picture(stand, ramp.at(min(s, move)), hidden="trails", cut=True)

    text = scenery.say("cut_open")

    def over(s: float) -> Over:
        rate, shown = ramp.rate(s) if s < move else 0.0, shown_in(s, 0.4, SECONDS - 0.2)
        return scenery.going(ramp.at(s), rate, strip=False, caption=text, caption_shown=shown)

    captions = (Caption(0.4, SECONDS - 0.2, text),)
    return Shot("section", scenery.say("section"), SECONDS, picture, over, ramp.at, captions)


def _busy(scenery: Scenery) -> float:
    """When what the story is about happens (s)."""
    return scenery.reasons[0].time if scenery.reasons else scenery.film.clock.start


def _turn(scenery: Scenery, cut: Film) -> float:
    """Degrees from the azimuth of the story to that of the film that is cut open, with its light."""
    here, there = (angles(film.shot.camera, film.parts.mount, film.aspect)[0] for film in (scenery.film, cut))
    return math.degrees(there - here)


def _side(scenery: Scenery) -> float:
    """1 for a cut that is seen from the right, or the front; -1 from the left."""
    cut = scenery.cut.shot.section if scenery.cut is not None else 0.0
    return -1.0 if isinstance(cut, Section) and cut.left else 1.0
