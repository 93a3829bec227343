"""Numbers beside the largest arrows of a picture that stands still."""

from __future__ import annotations

import math

import numpy as np

from render.film.framing import project
from render.film.story.frame import Note, Picture
from render.film.story.scenery import Scenery
from render.film.story.words import plain
from shared.contract.quantity import written
from shared.contract.signals import SIGNALS

MOST = 3
LEAST = 0.12
"""Arrows that are shorter than this part of the longest have no number."""
NEAR = 0.09
"""Tips that are nearer to each other, in the picture's shorter side, share the larger number."""


def notes(scenery: Scenery, picture: Picture) -> tuple[Note, ...]:
    """Names and sizes of the largest arrows, at their tips, as the picture's camera sees them."""
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
    for (middle, sweep), torque in zip(state.arcs, film.arcs.torques, strict=True):
        if scenery.reasons and torque.name.startswith(f"{scenery.reasons[0].name} on ") and sweep and not out:
            x, y = project(picture.camera, np.array(middle), wide, high)[0]
            words = f"{plain(scenery.reasons[0].name)}  {scenery.reasons[0].amount}"
            out.append(Note(float(x / wide), float(y / high), 0.0, -1.6, words, SIGNALS["torques"].dark))
    for k in sorted(range(len(rows)), key=lambda k: -lengths[k]):
        if lengths[k] < LEAST * longest or not longest or len(out) == MOST:
            break
        tail, tip = project(picture.camera, np.array(rows[k]), wide, high)
        if any(math.hypot(note.x * wide - tip[0], note.y * high - tip[1]) < NEAR for note in out):
            continue
        way = (tip - tail) / max(float(np.hypot(*(tip - tail))), 1e-9)
        vector = film.arrows.vectors[k]
        words = f"{plain(vector.name.partition(' of ')[2] or vector.name)}  {written(sizes[k], vector.unit)}"
        colour = SIGNALS[vector.row].dark
        out.append(Note(float(tip[0] / wide), float(tip[1] / high), float(way[0]), float(way[1]), words, colour))
    return tuple(out)
