"""The reason: time slows down into an event or a peak, stops, arrows grow, and a caption says what happens there."""

from __future__ import annotations

import numpy as np

from render.film.framing import project
from render.film.story.cameras import Stand, between
from render.film.story.frame import Caption, Over, Picture, Shot, shown_in
from render.film.story.ramp import Ramp, eased, into
from render.film.story.reason import Reason
from render.film.story.scenery import Scenery
from render.film.story.shots.notes import notes
from render.film.story.words import plain

GOES, SLOWS, GROWS, STANDS, ON = 0.9, 1.7, 0.8, 3.4, 1.3
"""Seconds: at the rate of the loop, slowing down, arrows growing, standing still, going on."""
GOES_AWAY = 0.3
"""Seconds in which arrows go when time goes on."""
BEFORE, AFTER = (9.0, 3.0), (3.0, 7.0)
"""Azimuth and elevation (degrees) beside those of the shot, when it begins and when time stands still."""
NEARER = (0.92, 0.96, 1.0, 1.05, 1.1, 1.2, 1.35)
"""Parts of the distance at which time stands still: the first from which all arrows are in the picture."""
EDGE = 0.03
"""Part of the picture at each side that arrows leave free."""


def reason(scenery: Scenery) -> Shot | None:
    """The stop at the first reason; None where the motion has none."""
    if not scenery.reasons:
        return None
    what, clock = scenery.reasons[0], scenery.film.clock
    goes, slows, grows, on = (scenery.moving(seconds) for seconds in (GOES, SLOWS, GROWS, ON))
    earliest = -1e300 if clock.repeats else clock.start
    ramp = into(what.time, earliest, clock.rate, goes, slows)
    stop = goes + slows
    begins = stop + grows + STANDS
    after = Ramp(ramp.at(stop), ((on, 0.0, clock.rate),))
    seconds = begins + on
    wide, near = _stands(scenery, ramp.at(stop))

    def model(s: float) -> float:
        return ramp.at(s) if s < begins else after.at(s - begins)

    def picture(s: float) -> Picture:
        way = eased(s / stop) if s < stop else 1.0
        grown = min(eased((s - stop) / grows), eased((begins + GOES_AWAY - s) / GOES_AWAY)) if s >= stop else 0.0
        return scenery.picture(between(wide, near, way), model(s), forces=True, grown=round(grown, 6), hidden="trails")

    text = scenery.wishes.caption or sentence(scenery, what)
    labels = notes(scenery, picture(begins - 0.1)) if scenery.forces is not None else ()

    def over(s: float) -> Over:
        rate = ramp.rate(s) if s < stop else 0.0 if s < begins else after.rate(s - begins)
        return scenery.going(
            model(s), rate, caption=text, caption_shown=shown_in(s, stop - 0.3, begins + 0.3),
            notes=labels, notes_shown=shown_in(s, stop + 0.7 * grows, begins),
        )  # fmt: skip

    captions = (Caption(stop - 0.3, begins + 0.3, text),)
    return Shot("reason", scenery.say("reason"), seconds, picture, over, model, captions)


def sentence(scenery: Scenery, what: Reason) -> str:
    """A caption in plain words."""
    with_force = what.kind in ("turns_back", "event") and what.joint
    key = f"{what.kind}_force" if with_force else what.kind
    return scenery.say(
        key, name=plain(what.name), amount=what.amount, force=what.force, joint=plain(what.joint)
    )  # fmt: skip


def _stands(scenery: Scenery, time: float) -> tuple[Stand, Stand]:
    """From a little aside, and nearer when time stands still at ``time`` (s)."""
    wide, near = (scenery.stand(*way, arrows=True) for way in (BEFORE, AFTER))
    stands = [Stand(near.target, near.azimuth, near.elevation, part * near.distance, near.lens) for part in NEARER]
    return wide, next((stand for stand in stands if _holds_arrows(scenery, stand, time)), stands[-1])


def _holds_arrows(scenery: Scenery, stand: Stand, time: float) -> bool:
    """Whether all straight arrows of that moment are in the picture from there."""
    film, seen = scenery.forces, scenery.picture(stand, time, forces=True, grown=1.0, hidden="trails")
    points = [end for arrow in film.state(seen.at, seen.camera).arrows for end in arrow] if film is not None else []
    if film is None or not points:
        return True
    wide, high = max(1.0, film.aspect), max(1.0, 1 / film.aspect)
    places = project(seen.camera, np.array(points), wide, high) / [wide, high]
    return bool(((places > EDGE) & (places < 1 - EDGE)).all())
