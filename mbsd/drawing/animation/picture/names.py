"""Names that go with what they name: each keeps one side of it over the whole clip, the one least in the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.drawing.animation.brush import Brush
from mbsd.drawing.animation.picture.sprites import sprite
from mbsd.drawing.names import offsets
from mbsd.model.mechanism import Model

DIRECTIONS = 12
DISTANCES = (0.0, 0.6, 1.4)
"""Beyond the clearance, in heights of the word."""
MARGIN = 2.0
"""Pixels."""


@dataclass(frozen=True)
class Placed:
    """One name."""

    number: int
    """Among the labels that the machine asks for, which come in the same order each time."""
    word: np.ndarray
    """See sprites.py."""
    off: np.ndarray
    """(2,) pixels from its anchor to its middle."""


def place_names(
    drawn: Sequence[Brush], frame: tuple[float, float, float, float], wanted: Sequence[int]
) -> list[Placed]:
    """For the ``wanted`` labels of some pictures whose obstacles were kept; ``frame``: left, low, right, top."""
    first = drawn[0]
    points = [brush.view.pixels(np.concatenate(brush.obstacles)) for brush in drawn]
    anchors = [brush.view.pixels([label.anchor for label in brush.labels]) for brush in drawn]
    out: list[Placed] = []
    taken: list[list[np.ndarray]] = [[] for _ in drawn]
    for number in wanted:
        label = first.labels[number]
        word = sprite(label.text, 0.92 * label.size, label.colour, first.dpi)
        size = np.array([word.shape[1], word.shape[0]]) + 2 * MARGIN
        offs = offsets(label.clearance * first.unit * first.view.scale, size, DIRECTIONS, DISTANCES)
        costs = np.arange(len(offs)) * 0.4
        for k in range(len(drawn)):
            costs += _costs(anchors[k][number] + np.array(offs), size, points[k], taken[k], frame)
        best = offs[int(np.argmin(costs))]
        for k in range(len(drawn)):
            taken[k].append(
                np.concatenate([anchors[k][number] + best - size / 2, anchors[k][number] + best + size / 2])
            )
        out.append(Placed(number, word, best))
    return out


def that_matter(m: Model) -> list[str]:
    """Names in the order in which they matter: what is driven, what comes out, traced points, then all other bodies."""
    driven = [name for driver in m.drivers.values() for name in driver.bodies if name != "ground"]
    grounded = [name for joint in m.joints.values() if "ground" in joint.bodies for name in joint.bodies[::-1]]
    out = [name for name in grounded if name != "ground" and name not in driven][-1:]
    first, others = (
        [*driven[:1], *out, *list(m.traces)[:1]],
        [*m.traces, *(name for name in m.bodies if name != "ground")],
    )
    return list(dict.fromkeys([*first, *others]))


def _costs(
    middles: np.ndarray,
    size: np.ndarray,
    points: np.ndarray,
    taken: list[np.ndarray],
    frame: tuple[float, float, float, float],
) -> np.ndarray:
    """(c,) of words with these middles (c, 2): what they cover, other words, the edge of the frame."""
    inside = (np.abs(points - middles[:, None]) < size / 2).all(axis=-1).sum(axis=1)
    low, high = middles - size / 2, middles + size / 2
    boxes = np.array(taken).reshape(-1, 1, 4)
    over = ((low < boxes[..., 2:]) & (high > boxes[..., :2])).all(axis=-1).sum(axis=0)
    outside = (low < frame[:2]).any(axis=1) | (high > frame[2:]).any(axis=1)
    return inside + 60.0 * over + 50.0 * outside
