"""The shot that takes a machine apart, with leaders to the names of its parts."""

from __future__ import annotations

import math

import numpy as np

from render.film.camera import Subject, angles
from render.film.composing import View
from render.film.framing import CameraPose, project
from render.film.story import frame
from render.film.story.frame import Caption, Leader, Over, Picture, Shot, shown_in
from render.film.story.ramps import EACH, eased, lifted
from render.film.story.scenery import MARGIN, Array, Scenery, Stand, between, posed, raised, stand
from render.film.story.words import plain
from shared.contract.quantity import written

# Leader lines of an exploded machine: from each body's main piece to its name and mass at an edge of the picture.

MOST_LEADERS = 8
"""Bodies that are named: of more, the heaviest."""
ROW = 0.085
"""Least distance from one name to the next, in the picture's shorter side."""


def leaders(scenery: Scenery, camera: CameraPose) -> tuple[Leader, ...]:
    """Return the leader lines of the machine when it is apart, as a camera sees it."""
    film = scenery.film
    wide, high = max(1.0, film.aspect), max(1.0, 1 / film.aspect)
    places: list[tuple[float, float, str, str]] = []
    for body, mass in _named(scenery):
        pieces = [lift for lift in scenery.lifts if lift.body == body]
        solids = film.parts.bodies[body].pieces
        main = max(pieces, key=lambda lift: (not solids[lift.piece].buy, solids[lift.piece].mass.volume))
        middle = scenery.piece(main, 1.0)
        at = (middle.min(axis=0) + middle.max(axis=0)) / 2
        x, y = (float(v) for v in project(camera, at, wide, high)[0])
        name = scenery.say("frame") if body == "ground" else plain(body)
        places.append((x / wide, y / high, name, written(mass, "kg") if mass > 0 else ""))
    places.sort()
    half = (len(places) + 1) // 2
    left, right = places[:half], places[half:]
    row = ROW / high
    low, top = 1 - frame.CAPTION / high - row, 0.07 / high
    return (*_side(left, False, row, top, low), *_side(right, True, row, top, low))


def _named(scenery: Scenery) -> list[tuple[str, float]]:
    """Return bodies with solids that get a name, and their masses (kg)."""
    film = scenery.film
    masses = {
        body: film.motion.bodies[body].mass if body in film.motion.bodies else solids.mass.mass
        for body, solids in film.parts.bodies.items()
        if solids.pieces and solids.spans is None
    }
    return sorted(masses.items(), key=lambda entry: -entry[1])[:MOST_LEADERS]


def _side(places: list[tuple[float, float, str, str]], right: bool, row: float, top: float, low: float) -> list[Leader]:
    """Return names at one side, ``row`` apart, in the order of their places.

    They go down from above, so that no two lines cross.
    """
    places = sorted(places, key=lambda place: place[1])
    heights = [min(max(y, top), low) for _, y, _, _ in places]
    for k in range(1, len(heights)):
        heights[k] = max(heights[k], heights[k - 1] + row)
    over = max(0.0, heights[-1] - low) if heights else 0.0
    if over:
        heights[-1] -= over
        for k in range(len(heights) - 2, -1, -1):
            heights[k] = min(heights[k], heights[k + 1] - row)
    return [
        Leader(x, y, name, mass, right, float(np.round(height, 6)))
        for (x, y, name, mass), height in zip(places, heights, strict=True)
    ]


# The assembly: parts lift apart in the order in which they are put together, get their names, and settle in.

WHOLE, LIFTS, SETTLED = 0.2, 1.7, 0.2
"""Seconds: as a whole, coming apart (and together), and as a whole again."""
APART, NAME, MOST_APART = 0.8, 0.2, 1.8
"""Seconds apart: of none, more for each name, and at most."""
LYING, STANDING = (12.0, -6.0), (42.0, 10.0)
"""Degrees: azimuth and elevation beside those of the shot for what lies, whose layers are seen from lower down; for
what stands an azimuth on the side of the shot's, from which layers are seen beside each other, and more elevation."""
MOST = 25.0
"""Degrees by which the azimuth differs from the shot's at most: light and ground are turned with that."""


def assembly(scenery: Scenery) -> Shot | None:
    """Return the assembly; None for a machine of one layer."""
    if not any(lift.distance for lift in scenery.lifts):
        return None
    lifts, move = scenery.lifts, scenery.moving(LIFTS)
    together, begin = _points(scenery, 0.0), scenery.film.clock.start
    spread = _points(scenery, 1.0)
    points = np.concatenate([together, spread])
    top = float(points[:, 2].max())
    near, wide = (raised(_stand(scenery, held), scenery.up, top) for held in (together, points))
    blur = scenery.film.shot.camera.blur
    whole, rests = scenery.whole(WHOLE), scenery.whole(min(APART + NAME * len(_named(scenery)), MOST_APART))
    out = whole + move
    back = out + rests
    seconds = back + move + SETTLED

    def apart(s: float) -> float:
        """Return how far all is apart, 0 .. 1: what came last goes first, and comes back last."""
        return min(max((s - whole) / move, 0.0), 1.0, max((back + move - s) / move, 0.0))

    def picture(s: float) -> Picture:
        part = round(apart(s), 6)
        heights = zip(lifts, lifted(lifts, part), strict=True)
        placed = [(lift.name, round(height, 9)) for lift, height in heights if height > 0]
        way = eased(part / EACH)  # all of it is seen while what came last leaves first
        sharp = together + way * (spread - together)
        camera = posed(between(near, wide, way), scenery.up, sharp, blur)
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
    """Return points (n, 3) around all pieces, lifted by a part of their distances (m)."""
    return np.concatenate([scenery.piece(lift, apart) for lift in scenery.lifts])


def _stand(scenery: Scenery, points: Array) -> Stand:
    """Return a stand that holds points (n, 3) around the machine."""
    film = scenery.film
    lies = film.parts.mount.kind == "desk"
    azimuth, elevation = LYING if lies else STANDING
    if not lies:
        usual = math.degrees(angles(film.shot.camera, film.parts.mount, film.aspect)[0])
        azimuth = min(max(math.copysign(azimuth, usual) - usual, -MOST), MOST)
    subject = Subject(points, np.zeros((0, 3)), np.zeros((0, 3)), points)
    at = scenery.stand(azimuth, elevation, strip=False)
    empty = frame.above(film.aspect), frame.below(film.aspect, False)
    view = View(at.azimuth, at.elevation, film.shot.camera.lens, MARGIN, empty, film.aspect)
    return stand(subject, scenery.up, view)
