"""Shots that explain: the moment to look at, the loop with its curve, and notes."""

from __future__ import annotations

import math

import numpy as np

from render.film.framing import project
from render.film.story.frame import Caption, Note, Over, Picture, Shot, shown_in
from render.film.story.ramps import Ramp, eased, into
from render.film.story.scenery import Scenery, Stand, between, turned
from render.film.story.words import plain
from shared.contract.quantity import figures, written
from shared.contract.signals import SIGNALS

# Numbers beside the largest arrows of a picture that stands still.

EFFORTS = ("N", "N m")
MOST = 3
LEAST = 0.12
"""Arrows that are shorter than this part of the longest have no number."""
NEAR = 0.09
"""Tips that are nearer to each other, in the picture's shorter side, share the larger number."""


def notes(scenery: Scenery, picture: Picture) -> tuple[Note, ...]:
    """Return names and sizes of the largest arrows, at their tips, as the picture's camera sees them."""
    film = scenery.forces
    assert film is not None
    time = film.clock.moment(picture.at).time
    state = film.state(picture.at, picture.camera)
    rows = state.arrows
    wide, high = max(1.0, film.aspect), max(1.0, 1 / film.aspect)
    sizes = [float(np.interp(time, film.poses.time, vector.size)) for vector in film.arrows.vectors]
    lengths = [math.dist(tail, tip) for tail, tip in rows]
    longest = max(lengths, default=0.0)
    out: list[Note] = []
    what = scenery.reasons[0] if scenery.reasons else None
    for (middle, sweep, _), torque in zip(state.arcs, film.arcs.torques, strict=True):
        name = torque.name.partition(" on ")[0]
        if what is not None and name in what.joints and what.unit in EFFORTS and sweep and not out:
            x, y = project(picture.camera, np.array(middle), wide, high)[0]
            words = f"{plain(name)}  {written(what.number, what.unit)}"
            out.append(Note(float(x / wide), float(y / high), 0.0, -1.6, words, SIGNALS["torques"].dark))
    for k in sorted(range(len(rows)), key=lambda k: -lengths[k]):
        if lengths[k] < LEAST * longest or not longest or len(out) == MOST:
            break
        tail, tip = project(picture.camera, np.array(rows[k]), wide, high)
        if any(math.hypot(note.x * wide - tip[0], note.y * high - tip[1]) < NEAR for note in out):
            continue
        way = (tip - tail) / max(float(np.hypot(*(tip - tail))), 1e-9)
        vector = film.arrows.vectors[k]
        name = "weight" if vector.weight else vector.name.partition(" on ")[0].partition(" of ")[2] or vector.name
        words = f"{plain(name.partition(' on ')[0])}  {written(sizes[k], vector.unit)}"
        colour = SIGNALS[vector.row].dark
        out.append(Note(float(tip[0] / wide), float(tip[1] / high), float(way[0]), float(way[1]), words, colour))
    return tuple(out)


# The reason: time slows down into an event or a peak, stops, arrows grow, and a caption says what happens there.

GOES, SLOWS, GROWS, STANDS, ON = 1.4, 1.7, 0.8, 1.7, 1.7
"""Seconds: at the rate of the loop, slowing down, arrows growing, standing still, going on."""
GOES_AWAY = 0.3
"""Seconds in which arrows go when time goes on."""
BEFORE, AFTER = (9.0, 3.0), (3.0, 7.0)
"""Azimuth and elevation (degrees) beside those of the shot, when it begins and when time stands still."""
ROUND = 8.0
"""Degrees by which the camera goes round while time stands still, where it turns at all."""
NEARER = (0.92, 0.96, 1.0, 1.05, 1.1, 1.2, 1.35)
"""Parts of the distance at which time stands still: the first from which all arrows are in the picture, and neither
plate nor stand is cut by a sliver."""
EDGE = 0.03
"""Part of the picture at each side that arrows leave free."""


def reason(scenery: Scenery) -> Shot | None:
    """Return the stop at the first reason; None where the motion has none."""
    if not scenery.reasons:
        return None
    what, clock = scenery.reasons[0], scenery.film.clock
    goes, slows, grows, on = (scenery.moving(seconds) for seconds in (GOES, SLOWS, GROWS, ON))
    earliest = -1e300 if clock.repeats else clock.start
    ramp = into(what.start, earliest, clock.rate, goes, slows)
    stop = goes + slows
    begins = stop + grows + STANDS
    after = Ramp(ramp.time_at(stop), ((on, 0.0, clock.rate),))
    seconds = begins + on
    wide, near = _stands(scenery, ramp.time_at(stop))
    round_it = turned(near, ROUND, 0.0, 1.0)
    goes_round = scenery.turning and not scenery.misses(round_it)
    beyond = round_it if goes_round and _holds_arrows(scenery, round_it, ramp.time_at(stop)) else near

    def model(s: float) -> float:
        return ramp.time_at(s) if s < begins else after.time_at(s - begins)

    def picture(s: float) -> Picture:
        stand = (
            between(wide, near, eased(s / stop)) if s < stop else between(near, beyond, (s - stop) / (seconds - stop))
        )
        grown = min(eased((s - stop) / grows), eased((begins + GOES_AWAY - s) / GOES_AWAY)) if s >= stop else 0.0
        return scenery.picture(stand, model(s), forces=True, grown=round(grown, 6), hidden="trails")

    text = scenery.wishes.caption or scenery.sentence(what)
    labels = notes(scenery, picture(begins - 0.1)) if scenery.forces is not None else ()

    def over(s: float) -> Over:
        rate = ramp.shown_rate(s) if s < stop else 0.0 if s < begins else after.shown_rate(s - begins)
        return scenery.going(
            model(s), rate, caption=text, caption_shown=shown_in(s, stop - 0.3, begins + 0.3),
            notes=labels, notes_shown=shown_in(s, stop + 0.7 * grows, begins),
        )  # fmt: skip

    captions = (Caption(stop - 0.3, begins + 0.3, text),)
    return Shot("reason", scenery.say("reason"), seconds, picture, over, model, captions)


def _stands(scenery: Scenery, time: float) -> tuple[Stand, Stand]:
    """Return the stands: from a little aside, and nearer when time stands still at ``time`` (s)."""
    wide, near = (scenery.stand(*way, arrows=True) for way in (BEFORE, AFTER))
    stands = [Stand(near.target, near.azimuth, near.elevation, part * near.distance, near.lens) for part in NEARER]
    held = [stand for stand in stands if _holds_arrows(scenery, stand, time)] or stands[-1:]
    return wide, next((stand for stand in held if not scenery.misses(stand)), held[0])


def _holds_arrows(scenery: Scenery, stand: Stand, time: float) -> bool:
    """Return True if all straight arrows of that moment are in the picture from there."""
    film, seen = scenery.forces, scenery.picture(stand, time, forces=True, grown=1.0, hidden="trails")
    points = [end for arrow in film.state(seen.at, seen.camera).arrows for end in arrow] if film is not None else []
    if film is None or not points:
        return True
    wide, high = max(1.0, film.aspect), max(1.0, 1 / film.aspect)
    places = project(seen.camera, np.array(points), wide, high) / [wide, high]
    return bool(((places > EDGE) & (places < 1 - EDGE)).all())


# A loop for a silent screen: it moves, slows into its event, stops with arrows and a caption, and ends as it began.

LOOP_SLOWS, LOOP_GROWS, LOOP_GOES = 1.1, 0.6, 0.3
LOOP_STANDS = 0.26
"""Part of the loop in which time stands still, arrows growing not counted, ..."""
LONGEST = 3.6
"""... and at most so many seconds."""
MIDDLE = 0.55
"""Part of what moves that comes before the stop, of a motion that may begin anywhere."""
DIP = 0.4
"""Seconds in which a motion that does not repeat goes into the dark at its end, and comes out of it at its start."""


def loop(scenery: Scenery, seconds: float) -> Shot:
    """Return the loop: of a motion with a period whole periods, of another all of it."""
    clock, what = scenery.film.clock, scenery.reasons[0] if scenery.reasons else None
    period = clock.end - clock.start
    if what is None:
        turns = max(1, round(clock.rate * seconds / period)) if clock.repeats else 1
        ramp = Ramp(clock.start, ((seconds, turns * period / seconds, turns * period / seconds),))
        stop = begins = seconds
    else:
        stands = min(LOOP_STANDS * seconds, LONGEST)
        slows, part = min(LOOP_SLOWS, 0.12 * seconds), MIDDLE
        if not clock.repeats:  # it stops at its event, however near that is to the start or the end
            part = min(max((what.start - clock.start) / period, 0.0), 1.0)
            slows = min(slows, 2 * min(part, 1 - part) * (seconds - LOOP_GROWS - stands - slows))
        moves = seconds - LOOP_GROWS - stands - slows  # at the whole rate; slowing and speeding up go half as far
        turns = max(1, round(clock.rate * moves / period)) if clock.repeats else 1
        rate = turns * period / moves
        before = max(part * moves - slows / 2, 0.0)
        after = max(moves - before - slows, 0.0)
        start = what.start - rate * (before + slows / 2) if clock.repeats else clock.start
        ramp = Ramp(
            start,
            (
                (before, rate, rate), (slows, rate, 0.0), (LOOP_GROWS + stands, 0.0, 0.0), (slows, 0.0, rate),
                (after, rate, rate),
            ),
        )  # fmt: skip
        stop = before + slows
        begins = stop + LOOP_GROWS + stands
    stand = scenery.stand(arrows=True)

    def picture(s: float) -> Picture:
        grown = min(eased((s - stop) / LOOP_GROWS), eased((begins + LOOP_GOES - s) / LOOP_GOES)) if s >= stop else 0.0
        return scenery.picture(stand, ramp.time_at(s), forces=True, grown=round(grown, 6))

    text = "" if what is None else scenery.wishes.caption or scenery.sentence(what)
    name = plain(scenery.film.motion.mechanism.partition("-")[0])
    name = f"{name[:1].upper()}{name[1:]}. "
    insight = scenery.of_motion
    name += scenery.say("lasts", time=f"{figures(period, 3)} s") if insight is None else scenery.sentence(insight)
    labels = notes(scenery, picture(begins - 0.05)) if scenery.forces is not None and what is not None else ()
    rows = [Caption(0.3, max(stop - 0.5, 0.8), name), Caption(stop - 0.3, min(begins + 0.5, seconds), text)]
    captions = tuple(row for row in rows if row.text and row.end - row.start > 0.6)

    def over(s: float) -> Over:
        here = next((row for row in captions if row.start <= s < row.end), None)
        dark = 0.0 if clock.repeats else 1 - min(s / DIP, (seconds - s) / DIP, 1.0)
        return scenery.going(
            ramp.time_at(s), ramp.shown_rate(s), caption=here.text if here else "", dark=max(dark, 0.0),
            caption_shown=shown_in(s, here.start, here.end, 0.25) if here else 0.0,
            notes=labels, notes_shown=shown_in(s, stop + 0.7 * LOOP_GROWS, begins),
        )  # fmt: skip

    return Shot("loop", scenery.say("motion"), seconds, picture, over, ramp.time_at, captions)
