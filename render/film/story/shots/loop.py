"""A loop for a silent screen: it moves, slows into its event, stops with arrows and a caption, and ends as it began."""

from __future__ import annotations

from render.film.story.frame import Caption, Over, Picture, Shot, shown_in
from render.film.story.ramp import Ramp, eased
from render.film.story.scenery import Scenery
from render.film.story.shots.notes import notes
from render.film.story.shots.reason import sentence
from render.film.story.words import plain
from shared.contract.quantity import figures

SLOWS, GROWS, GOES = 1.1, 0.6, 0.3
STANDS = 0.26
"""Part of the loop in which time stands still, arrows growing not counted, ..."""
LONGEST = 3.6
"""... and at most so many seconds."""
MIDDLE = 0.55
"""Part of what moves that comes before the stop, of a motion that may begin anywhere."""
DIP = 0.4
"""Seconds in which a motion that does not repeat goes into the dark at its end, and comes out of it at its start."""


def loop(scenery: Scenery, seconds: float) -> Shot:
    """The loop: of a motion with a period whole periods, of another all of it."""
    clock, what = scenery.film.clock, scenery.reasons[0] if scenery.reasons else None
    period = clock.end - clock.start
    if what is None:
        turns = max(1, round(clock.rate * seconds / period)) if clock.repeats else 1
        ramp = Ramp(clock.start, ((seconds, turns * period / seconds, turns * period / seconds),))
        stop = begins = seconds
    else:
        stands = min(STANDS * seconds, LONGEST)
        slows, part = min(SLOWS, 0.12 * seconds), MIDDLE
        if not clock.repeats:  # it stops at its event, however near that is to the start or the end
            part = min(max((what.time - clock.start) / period, 0.0), 1.0)
            slows = min(slows, 2 * min(part, 1 - part) * (seconds - GROWS - stands - slows))
        moves = seconds - GROWS - stands - slows  # at the whole rate; slowing and speeding up go half as far
        turns = max(1, round(clock.rate * moves / period)) if clock.repeats else 1
        rate = turns * period / moves
        before = max(part * moves - slows / 2, 0.0)
        after = max(moves - before - slows, 0.0)
        start = what.time - rate * (before + slows / 2) if clock.repeats else clock.start
        ramp = Ramp(
            start,
            (
                (before, rate, rate), (slows, rate, 0.0), (GROWS + stands, 0.0, 0.0), (slows, 0.0, rate),
                (after, rate, rate),
            ),
        )  # fmt: skip
        stop = before + slows
        begins = stop + GROWS + stands
    stand = scenery.stand(arrows=True)

    def picture(s: float) -> Picture:
        grown = min(eased((s - stop) / GROWS), eased((begins + GOES - s) / GOES)) if s >= stop else 0.0
        return scenery.picture(stand, ramp.at(s), forces=True, grown=round(grown, 6))

    text = "" if what is None else scenery.wishes.caption or sentence(scenery, what)
    name = plain(scenery.film.motion.mechanism.partition("-")[0])
    name = f"{name[:1].upper()}{name[1:]}. "
    name += scenery.say("repeats" if clock.repeats else "lasts", time=f"{figures(period, 3)} s")
    labels = notes(scenery, picture(begins - 0.05)) if scenery.forces is not None and what is not None else ()
    rows = [Caption(0.3, max(stop - 0.5, 0.8), name), Caption(stop - 0.3, min(begins + 0.5, seconds), text)]
    captions = tuple(row for row in rows if row.text and row.end - row.start > 0.6)

    def over(s: float) -> Over:
        here = next((row for row in captions if row.start <= s < row.end), None)
        dark = 0.0 if clock.repeats else 1 - min(s / DIP, (seconds - s) / DIP, 1.0)
        return scenery.going(
            ramp.at(s), ramp.rate(s), caption=here.text if here else "", dark=max(dark, 0.0),
            caption_shown=shown_in(s, here.start, here.end, 0.25) if here else 0.0,
            notes=labels, notes_shown=shown_in(s, stop + 0.7 * GROWS, begins),
        )  # fmt: skip

    return Shot("loop", scenery.say("motion"), seconds, picture, over, ramp.at, captions)
