"""Leader lines of an exploded machine: from each body's main piece to its name and mass at an edge of the picture."""

from __future__ import annotations

import numpy as np

from render.film.framing import CameraPose, project
from render.film.story import layout
from render.film.story.frame import Leader
from render.film.story.scenery import Scenery
from render.film.story.words import plain
from shared.contract.quantity import written

MOST = 8
"""Bodies that are named: of more, the heaviest."""
ROW = 0.085
"""From one name to the next at least, in the picture's shorter side."""


def leaders(scenery: Scenery, camera: CameraPose) -> tuple[Leader, ...]:
    """The leader lines of the machine when it is apart, as a camera sees it."""
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
    low, top = 1 - layout.CAPTION / high - row, 0.07 / high
    return (*_side(left, False, row, top, low), *_side(right, True, row, top, low))


def _named(scenery: Scenery) -> list[tuple[str, float]]:
    """Bodies with solids that get a name, and their masses (kg)."""
    film = scenery.film
    masses = {
        body: film.motion.bodies[body].mass if body in film.motion.bodies else solids.mass.mass
        for body, solids in film.parts.bodies.items()
        if solids.pieces and solids.spans is None
    }
    return sorted(masses.items(), key=lambda entry: -entry[1])[:MOST]


def _side(places: list[tuple[float, float, str, str]], right: bool, row: float, top: float, low: float) -> list[Leader]:
    """Names at one side, from above in the order of their places, so that no two lines cross; ``row`` apart."""
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
