"""The assembly: parts lift apart in the order in which they are put together, get their names, and settle in."""

from __future__ import annotations

import math

import numpy as np

from render.film.camera import Subject, angles
from render.film.composing.filling import View
from render.film.story import cameras, layout
from render.film.story.cameras import Stand
from render.film.story.frame import Caption, Over, Picture, Shot, shown_in
from render.film.story.lifting import EACH, lifted
from render.film.story.ramp import eased
from render.film.story.scenery import MARGIN, Array, Scenery
from render.film.story.shots.leaders import leaders
from shared.contract.quantity import written

WHOLE, LIFTS, APART, SETTLED = 0.5, 1.7, 3.2, 0.5
"""Seconds: as a whole, coming apart (and together), apart, and as a whole again."""
LYING, STANDING = (12.0, -6.0), (42.0, 10.0)
"""Degrees: azimuth and elevation beside those of the shot for what lies, whose layers are seen from lower down; for
what stands an azimuth on the side of the shot's, from which layers are seen beside each other, and more elevation."""
MOST = 25.0
"""Degrees by which the azimuth differs from the shot's at most: light and ground are turned with that."""


def assembly(scenery: Scenery) -> Shot | None:
    """The assembly; None of a machine of one layer."""
    if not any(lift.distance for lift in scenery.lifts):
        return None
    lifts, move = scenery.lifts, scenery.moving(LIFTS)
    together, begin = _points(scenery, 0.0), scenery.film.clock.start
    spread = _points(scenery, 1.0)
    points = np.concatenate([together, spread])
    top = float(points[:, 2].max())
    near, wide = (cameras.raised(_stand(scenery, held), scenery.up, top) for held in (together, points))
    blur = scenery.film.shot.camera.blur
    whole, rests = scenery.whole(WHOLE), scenery.whole(APART)
    out = whole + move
    back = out + rests
    seconds = back + move + SETTLED

    def apart(s: float) -> float:
        """How far all is apart, 0 .. 1: what came last goes first, and comes back last."""
        return min(max((s - whole) / move, 0.0), 1.0, max((back + move - s) / move, 0.0))

    def picture(s: float) -> Picture:
        part = round(apart(s), 6)
        heights = zip(lifts, lifted(lifts, part), strict=True)
        placed = [(lift.name, round(height, 9)) for lift, height in heights if height > 0]
        way = eased(part / EACH)  # all of it is seen while what came last leaves first
        sharp = together + way * (spread - together)
        camera = cameras.posed(cameras.between(near, wide, way), scenery.up, sharp, blur)
        return Picture(at=0.0, camera=camera, lifts=tuple(sorted(placed)), hidden="all")

    lines, text = leaders(scenery, picture(out + rests / 2).camera), _caption(scenery)

    def over(s: float) -> Over:
        return Over(
            leaders=lines, leaders_shown=shown_in(s, out - 0.15, back + 0.1, 0.4), caption=text,
            caption_shown=shown_in(s, out - 0.3, back + 0.3),
        )  # fmt: skip

    captions = (Caption(out - 0.3, back + 0.3, text),)
    return Shot("assembly", scenery.say("assembly"), seconds, picture, over, lambda s: begin, captions)


def _caption(scenery: Scenery) -> str:
    motion, count = scenery.film.motion, len(scenery.lifts)
    if count == 1:
        return scenery.say("together_one")
    moving = sum(body.mass for body in motion.bodies.values())
    return scenery.say(
        "together", count=str(count), layers=str(scenery.lifts[-1].order + 1), mass=written(moving, "kg")
    )


def _points(scenery: Scenery, apart: float) -> Array:
    """Points (n, 3) around all pieces, lifted by a part of their distances (m)."""
    return np.concatenate([scenery.piece(lift, apart) for lift in scenery.lifts])


def _stand(scenery: Scenery, points: Array) -> Stand:
    """A stand that holds points (n, 3) around the machine."""
    film = scenery.film
    lies = film.parts.mount.kind == "desk"
    azimuth, elevation = LYING if lies else STANDING
    if not lies:
        usual = math.degrees(angles(film.shot.camera, film.parts.mount, film.aspect)[0])
        azimuth = min(max(math.copysign(azimuth, usual) - usual, -MOST), MOST)
    subject = Subject(points, np.zeros((0, 3)), np.zeros((0, 3)), points)
    at = scenery.stand(azimuth, elevation, strip=False)
    empty = layout.above(film.aspect), layout.below(film.aspect, False)
    view = View(at.azimuth, at.elevation, film.shot.camera.lens, MARGIN, empty, film.aspect)
    return cameras.stand(subject, scenery.up, view)
