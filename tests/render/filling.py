"""How much of a picture a machine fills, and what its words cover, from its files alone: no Blender."""

from __future__ import annotations

import numpy as np

from render.film import composing
from render.film.film import Film
from render.film.framing import project

LOOKED = 90
"""Frames of a film that are looked at."""
Box = tuple[float, float, float, float]


def places(film: Film) -> np.ndarray:
    """Where points of all that moves, springs and belts included, are in the picture (n, 2), as parts of its width and
    height, over the film.
    """
    frames = np.unique(np.linspace(0, film.clock.frames - 1, LOOKED).astype(int))
    seen = []
    for frame in frames:
        solids = film.space.places(np.array([film.clock.moment(int(frame)).time]))[0]
        points = np.concatenate([solids, *(np.asarray(path) for path in film.state(int(frame)).tubes)])
        seen.append(project(film.camera(int(frame)), points, film.aspect, 1.0) / [film.aspect, 1.0])
    return np.concatenate(seen)


def filled(film: Film) -> float:
    """The part of the picture's width or height, whichever is more, that the machine takes over the film."""
    seen = places(film)
    assert seen.min() > 0.0
    assert seen.max() < 1.0
    return float(np.ptp(seen, axis=0).max())


def boxes(film: Film) -> list[Box]:
    """Return the box of each line and of the legend, as parts of the picture's width and height."""
    writing = film.scene.writing
    rectangles = [(line.x, line.y, line.x + line.width, line.y + line.size) for line in writing.lines]
    if writing.card is not None:
        card = writing.card
        rectangles.append((card.left, card.top, card.left + card.wide, card.top + card.high))
    return [composing.in_picture(box, film.aspect) for box in rectangles]


def refuse_overlaps(rectangles: list[Box]) -> None:
    """Asserts that all are in the picture, and apart from each other."""
    for k, (left, upper, right, lower) in enumerate(rectangles):
        assert 0.0 < left < right < 1.0
        assert 0.0 < upper < lower < 1.0
        for other in rectangles[:k]:
            assert right < other[0] or other[2] < left or lower < other[1] or other[3] < upper, (rectangles[k], other)
