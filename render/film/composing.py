"""Composition of a picture: how it is filled, room for words, and a camera that follows."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import msgspec
import numpy as np
from numpy.typing import NDArray

from render.film.framing import CameraPose, Empty, axes, fit, half_field, project
from render.film.scene import ARC, Card, LegendRow, LineSpec
from render.letters import width_of
from render.presets import ASPECT

# How much of a picture the machine fills, and how much of what stands around it is worth a smaller machine.

Array = NDArray[np.float64]
FILLED = 0.8
"""Part of the picture's width, or of the height that titles leave, that the machine fills at least."""
AIM = 0.81
"""The same as it is composed, for what a search leaves open."""
DRAWN = 0.88
"""Arrows count as if they were so near to the machine: their tips may come into the margins, which stay theirs."""
WAYS = 256
"""Directions in which points count while the part of the surroundings is looked for."""
STEPS = 12


@dataclass(frozen=True)
class View:
    """From where one looks, and at a picture of which shape. Angles in rad, lens in mm."""

    azimuth: float
    elevation: float
    lens: float
    margin: float
    empty: Empty = (0.0, 0.0)
    aspect: float = ASPECT
    aside: float = 0.0
    """Part of the width that stays empty at the right."""

    def stand(self, points: Array) -> tuple[Array, float]:
        """Return the closest place (3,) of a camera that holds points (n, 3), and its distance (m) to them.

        The distance is to their middle.
        """
        return fit(points, self.azimuth, self.elevation, self.lens, self.margin, self.empty, self.aspect, self.aside)

    def filled(self, points: Array, position: Array) -> tuple[float, float]:
        """Return parts of the picture's width and height that points (n, 3) take, seen from ``position`` (3,)."""
        u, v, w = ((points - position) @ axes(self.azimuth, self.elevation).T).T
        half = half_field(self.lens, self.aspect)
        across, up = (float(np.ptp(part / w)) / (2 * side) for part, side in zip((u, v), half, strict=True))
        return across, up


KEPT = 0.75
"""Part of what the machine may fill that it fills at least, in a picture that is wider for what stands around."""
NEAR_MISS, AIR = 0.17, 0.96
"""Least part of its area by which a thing is cut, for a sliver looks like a mistake; room beside what is whole."""
TRIES = 16
"""Parts of what stands around that are tried."""


def held(
    view: View,
    machine: Array,
    around: Array,
    drawn: Array,
    few: Array | None = None,
    things: Sequence[Array] = (),
) -> Array:
    """Return points (n, 3) that a picture holds.

    These are all of the ``machine`` (m, 3), arrows that are ``drawn`` (k, 3) about it, and what stands ``around`` (l,
    3) as far as the machine then fills :data:`FILLED`; beyond that, it may leave the frame. Where one of the ``things``
    (i, 3) among it would be cut, the picture is wider until all are whole, as long as the machine fills :data:`KEPT` of
    that; else it is closer, so that things are cut on purpose. ``few`` are the :func:`outermost` of the machine, where
    they are known.
    """
    middle = (machine.min(axis=0) + machine.max(axis=0)) / 2
    drawn = middle + DRAWN * (drawn - middle)
    if not len(around):
        return np.concatenate([machine, drawn])
    few, rest = outermost(machine) if few is None else few, outermost(around)
    arrows = outermost(drawn)
    most, room = min(AIM, 0.99 * (1 - 2 * view.margin)), 1 - 2 * view.margin
    left = 1 - sum(min(part / room, 1 / 3) for part in view.empty)  # of the height, by what is written

    def stood(part: float) -> Array:
        return view.stand(np.concatenate([few, arrows, middle + part * (rest - middle)]))[0]

    def fills(part: float) -> float:
        across, up = view.filled(few, stood(part))
        return max(across / (1 - view.aside), up / left)

    low, high = 0.0, 1.0
    if fills(high) >= most:
        low = high
    else:
        for _ in range(STEPS):
            half = (low + high) / 2
            low, high = (half, high) if fills(half) >= most else (low, half)
        low = _uncut(view, stood, things, low, lambda part: fills(part) >= 0.98 * KEPT * most)
    return np.concatenate([machine, drawn, middle + low * (around - middle)])


def _uncut(
    view: View, stood: Callable[[float], Array], things: Sequence[Array], low: float, is_large: Callable[[float], bool]
) -> float:
    """Return the part of the surroundings from which no thing is cut by a sliver.

    It is the closest from which all are whole while the machine ``is_large``, else one near ``low`` that cuts on
    purpose.
    """
    if not things:
        return low
    wider = [float(part) for part in np.linspace(low, 1.0, 5 * TRIES) if part == low or is_large(part)]
    for part in wider:
        if all(cut_share(view, stood(part), thing, AIR) < WHOLE for thing in things):
            return part
    parts = [*np.linspace(low, 0.0, TRIES), *wider[1:]]
    misses = [max(near_miss(view, stood(part), thing) for thing in things) for part in parts]
    return float(parts[int(np.argmin(np.round(misses, 3)))])


def near_miss(view: View, position: Array, thing: Array) -> float:
    """Return how near a cut of a thing (n, 3) is to none, or to one by :data:`NEAR_MISS`; 0 where it is neither."""
    share = cut_share(view, position, thing, AIR)
    return min(share, NEAR_MISS - share) if WHOLE < share < NEAR_MISS else 0.0


WHOLE = 1e-3
"""A thing of which less is cut is whole."""


def cut_share(view: View, position: Array, thing: Array, edge: float = 1.0) -> float:
    """Return the part of the area of a convex thing (n, 3) that is out of the picture from ``position`` (3,).

    ``edge``: part of the picture that counts as its inside.
    """
    inside, whole = _areas(view, position, thing, edge)
    return 1.0 - inside / whole if whole > 0 else 0.0


def shown_area(view: View, position: Array, thing: Array) -> float:
    """Return the part of the picture's area that the outline of a thing (n, 3) takes, from ``position`` (3,)."""
    return _areas(view, position, thing, 1.0)[0] / 4


def _areas(view: View, position: Array, thing: Array, edge: float) -> tuple[float, float]:
    """Return the areas of a thing's outline in the picture, and of all of it; that of the picture is 4."""
    u, v, w = ((thing - position) @ axes(view.azimuth, view.elevation).T).T
    half = half_field(view.lens, view.aspect)
    seen = np.stack([u / np.maximum(w, 1e-9) / half[0], v / np.maximum(w, 1e-9) / half[1]], axis=1) / edge
    corners = _hull(seen)
    whole, inside = area(corners), corners
    for axis in (0, 1):
        for side in (-1.0, 1.0):
            inside = _clipped(inside, axis, side)
    return area(inside), whole


def area(corners: Array) -> float:
    """Return the area of a polygon (n, 2)."""
    if len(corners) < 3:
        return 0.0
    ahead = np.roll(corners, -1, axis=0)
    return float(abs((corners[:, 0] * ahead[:, 1] - corners[:, 1] * ahead[:, 0]).sum())) / 2


def _hull(points: Array) -> Array:
    from scipy.spatial import ConvexHull, QhullError

    try:
        return points[ConvexHull(points).vertices]
    except QhullError:
        return points[:0]


def _clipped(corners: Array, axis: int, side: float) -> Array:
    """Return a convex polygon (n, 2) cut off where ``side`` times a coordinate is above 1."""
    out: list[Array] = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        da, db = 1.0 - side * a[axis], 1.0 - side * b[axis]
        if da >= 0:
            out.append(a)
        if (da < 0) != (db < 0):
            out.append(a + da / (da - db) * (b - a))
    return np.array(out).reshape(-1, 2)


def outermost(points: Array) -> Array:
    """Return the points (n, 3) that are farthest in some direction of a sphere; few where there are many."""
    if len(points) <= WAYS:
        return points
    k = np.arange(WAYS) + 0.5
    up, turn = 1 - 2 * k / WAYS, np.pi * (1 + 5**0.5) * k
    flat = np.sqrt(1 - up**2)
    ways = np.stack([flat * np.cos(turn), flat * np.sin(turn), up], axis=1)
    best = np.full(WAYS, -np.inf)
    chosen = np.zeros(WAYS, int)
    for first in range(0, len(points), 100_000):  # of a chain there are millions
        reach = ways @ points[first : first + 100_000].T
        at = reach.argmax(axis=1)
        top = reach[np.arange(WAYS), at]
        better = top > best
        chosen[better] = first + at[better]
        best = np.maximum(best, top)
    return points[np.unique(chosen)]


# Where words stand in a picture of any shape: title, number and rate at the upper left, the legend in a corner.
#
# Lengths are parts of the picture's shorter side, so that letters have the same pixels in every shape of a preset.

EDGE = 0.046
"""Distance of what is written, from the picture's edges."""
TITLE, NUMBER, RATE, LEGEND, NOTE = 1 / 16, 1 / 23, 1 / 27, 1 / 25, 1 / 30
"""Heights of letters."""
LINE = 1.4
"""Distance from one line to the next, in heights of letters."""
SMALLER = 0.72
"""To this part letters shrink where a line is too wide, before it is broken into two."""
LEAST = 0.3
"""Nothing is smaller, as a part of its usual size."""
HALF = 0.5
"""Part of the picture's height that words at the upper left take at most."""
ROW, PAD, GAP = 1.5, 0.7, 0.8
"""Distances within the legend, in heights of letters: from row to row, around its rows, between its columns."""
Box = tuple[float, float, float, float]
"""Left, upper, right and lower edge, in parts of the picture's shorter side."""


def sides(aspect: float) -> tuple[float, float]:
    """Return the width and height of a picture, in its shorter side."""
    return max(1.0, aspect), max(1.0, 1 / aspect)


def lines(title: str, numbers: Sequence[str], rate: str, aspect: float) -> list[LineSpec]:
    """Return the lines at the upper left: title, live number and rate; None leaves the picture.

    The number has no words, and is as large as its widest value in ``numbers`` allows.
    """
    wide = sides(aspect)[0] - 2 * EDGE
    widest = max(numbers, key=width_of, default="")
    kept_lines: list[tuple[str, str, float, bool, bool]] = []
    if title:
        size, broken = _broken(title, TITLE, wide)
        kept_lines += [(words, words, size, True, False) for words in broken]
    if widest:
        kept_lines.append(("", widest, _fitting(widest, NUMBER, wide), False, False))
    if rate:
        kept_lines.append((rate, rate, _fitting(rate, RATE, wide), False, True))
    out, y = [], EDGE
    for words, measured, size, bold, quiet in kept_lines:
        width = size * width_of(measured, bold)
        out.append(LineSpec(words=words, x=EDGE, y=y, width=width, size=size, bold=bold, quiet=quiet))
        y += LINE * size
    return out


def note(words: str, aspect: float, y: float) -> list[LineSpec]:
    """Return the lines of a note under the height ``y``; none without words."""
    if not words:
        return []
    size, broken = _broken(words, NOTE, sides(aspect)[0] - 2 * EDGE, bold=False)
    return [
        LineSpec(words=line, x=EDGE, y=y + LINE * size * k, width=size * width_of(line), size=size, quiet=True)
        for k, line in enumerate(broken)
    ]


def box_of(lines: Sequence[LineSpec]) -> Box:
    """Return the place of the lines at the upper left, from the picture's corner on.

    It is empty without lines.
    """
    if not lines:
        return 0.0, 0.0, 0.0, 0.0
    return 0.0, 0.0, max(line.x + line.width for line in lines), max(line.y + LINE * line.size for line in lines)


def cards(rows: Sequence[LegendRow], over: Box, aspect: float) -> dict[str, Card]:
    """Return corners of places for a legend: in the picture, and clear of the words at ``over``.

    Its letters shrink where there is no such place.
    """
    if not rows:
        return {}
    part = 1.0
    while True:
        cards_of_rows = _cards(rows, part * LEGEND, aspect)
        free = {corner: card for corner, card in cards_of_rows.items() if _is_free(card, over, aspect)}
        if free or part < LEAST:
            return free or cards_of_rows
        part *= 0.92


def _cards(rows: Sequence[LegendRow], size: float, aspect: float) -> dict[str, Card]:
    wide, high = sides(aspect)
    pad, gap = PAD * size, GAP * size
    arrows = max(2.6 * ARC * size if row.sweep else row.length * wide for row in rows)
    numbers = size * max(width_of(row.number) for row in rows)
    words = size * max(width_of(row.words) for row in rows)
    width, height = 2 * pad + arrows + gap + numbers + gap + words, 2 * pad + (ROW * len(rows) - 0.3) * size
    left, right, upper, lower = EDGE, wide - EDGE - width, EDGE, high - EDGE - height
    card = Card(
        left=left, top=lower, wide=width, high=height, size=size, pad=pad, row=ROW * size, arrows=pad + arrows,
        numbers=pad + arrows + gap, words=pad + arrows + gap + numbers + gap,
    )  # fmt: skip
    places = {"lower left": (left, lower), "lower right": (right, lower), "upper right": (right, upper)}
    return {corner: msgspec.structs.replace(card, left=x, top=y) for corner, (x, y) in places.items()}


def _is_free(card: Card, over: Box, aspect: float) -> bool:
    """Return True if a card is in the picture and apart from the words."""
    wide, high = sides(aspect)
    right, lower, edge = card.left + card.wide, card.top + card.high, EDGE / 2
    inside = card.left >= edge and card.top >= edge and right <= wide - edge and lower <= high - edge
    return inside and not (card.left < over[2] + EDGE / 2 and card.top < over[3] + EDGE / 2 and over[2] > 0)


def in_picture(box: Box, aspect: float) -> Box:
    """Return a box in parts of the picture's width and height."""
    wide, high = sides(aspect)
    return box[0] / wide, box[1] / high, box[2] / wide, box[3] / high


def around(card: Card) -> Box:
    """Return the place that a legend keeps free: its card, out to the picture's edges."""
    return card.left - EDGE, card.top - EDGE, card.left + card.wide + EDGE, card.top + card.high + EDGE


def _fitting(words: str, size: float, wide: float) -> float:
    """Return the size of letters with which a line is not wider than that."""
    return min(size, wide / width_of(words))


def _broken(words: str, size: float, wide: float, bold: bool = True) -> tuple[float, list[str]]:
    """Return the size and lines of a title, or of words that are not ``bold``.

    It stands in one line, if need be smaller; else in two that are as alike as they can be.
    """
    alone = min(size, wide / width_of(words, bold))
    spaces = [k for k, letter in enumerate(words) if letter == " "]
    if alone >= SMALLER * size or not spaces:
        return alone, [words]
    at = min(spaces, key=lambda k: max(width_of(words[:k], bold), width_of(words[k + 1 :], bold)))
    both = [words[:at], words[at + 1 :]]
    return min(size, *(wide / width_of(line, bold) for line in both)), both


# Room for words: places of the picture in which nothing moves.

PARTS = 0.0, 0.04, 0.08, 0.12, 0.16, 0.2, 0.24
"""Fractions of the picture's height, kept empty at its top for words, at its bottom for a legend: the first enough."""


def count_held(camera: CameraPose, points: Array, place: Box, aspect: float = ASPECT) -> int:
    """Return the number of ``points`` (n, 3) in a place of the picture.

    The place is given by its left, upper, right and lower edge, in parts of the picture.
    """
    left, upper, right, lower = place
    size = np.array([aspect, 1.0])
    x, y = (project(camera, points, *size) / size).T
    return int(((x >= left) & (x <= right) & (y >= upper) & (y <= lower)).sum())


def is_free(poses: Sequence[CameraPose], moving: Array, place: Box, aspect: float = ASPECT) -> bool:
    """Return True if nothing that moves (n, 3) comes into a place of the picture."""
    return place[2] <= place[0] or not any(count_held(pose, moving, place, aspect) for pose in poses)


def emptiest(
    poses: Sequence[CameraPose], moving: Array, standing: Array, places: Mapping[str, Box], aspect: float = ASPECT
) -> str:
    """Return the corner of the picture with the fewest moving points (n, 3), then still ones (m, 3)."""

    def crowd(corner: str) -> tuple[int, ...]:
        here = places[corner]
        return tuple(sum(count_held(pose, points, here, aspect) for pose in poses) for points in (moving, standing))

    return min(places, key=crowd)


# A machine that goes away is followed: the way of a damped camera over the whole film, known before the first frame.
#
# The way is the middle of the machine, frame after frame, averaged with the weights of a bell as wide as
# :data:`DAMPED`. It lags behind nothing, since it knows what comes; it starts and stops softly, and closes where the
# film does.

DAMPED = 0.45
"""Standard deviation of the bell, in seconds of film."""
AWAY = 0.5
"""A machine travels if its places at two times are so many of its own lengths apart, at the least, ..."""
GONE = 0.6
"""... and if at the end it is so far from where it began, as a part of the length of the box around its way."""
WIDEST = 0.9
"""A subject is followed if its frame is less than this part of its sweep; else the camera may as well stand."""


def travels(places: Array, repeats: bool) -> bool:
    """Return True if a machine with points (T, n, 3) travels away for good.

    Points are at equal steps of the film. A pendulum swings about a place that it always covers, a planet comes back,
    and so does what ``repeats``.
    """
    if repeats or len(places) < 2:
        return False
    low, high = places.min(axis=1), places.max(axis=1)
    middles = (low + high) / 2
    apart = low.max(axis=0) - high.min(axis=0)
    longest = float((high - low).max())
    sweep = float(np.ptp(middles, axis=0).max())
    gone = float(np.abs(middles[-1] - middles[0]).max())
    return bool(apart.max() > AWAY * longest) and gone > GONE * sweep


def way(places: Array, frames: int, fps: float, repeats: bool) -> Array:
    """Return the way (frames, 3) of the camera's target past a machine with points (T, n, 3).

    It moves in the first T frames and stands at its last place in the others.
    """
    middles = (places.min(axis=1) + places.max(axis=1)) / 2
    middles = np.concatenate([middles, np.repeat(middles[-1:], max(0, frames - len(middles)), axis=0)])[:frames]
    return damped(middles, DAMPED * fps, repeats)


def damped(values: Array, width: float, repeats: bool) -> Array:
    """Return series (T, k) averaged with a bell of that standard deviation, in steps.

    The series are held at their ends, or closed.
    """
    reach = max(1, int(np.ceil(3.5 * width)))
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    weights /= weights.sum()
    count = len(values)
    at = np.arange(count)[:, None] + np.arange(-reach, reach + 1)
    at = at % count if repeats else np.clip(at, 0, count - 1)
    return np.einsum("tjk,j->tk", values[at], weights)
