"""Designs of a page: solved on a grid, checked between its nodes, kept in 16 bits a number."""

from __future__ import annotations

import hashlib
import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from render.view.document import encode
from studio.live.child.author import Author
from studio.live.child.described import described
from studio.live.numbers import Number, numbers_of
from studio.site.designs.vectors import Solved, form

# Interpolation on a tensor grid of Chebyshev points.
#
# With nodes x_j = cos(pi j / n), j = 0..n, of each axis, the barycentric form
#
#     w_j = (-1)^j, halved at both ends;    p(x) = sum_j [w_j / (x - x_j)] f_j / sum_j [w_j / (x - x_j)]
#
# is the polynomial of degree n through all f_j; its error falls geometrically with n where f is smooth (Berrut and
# Trefethen, SIAM Review 46, 2004, eq. 4.2 and 5.4). The page has the same lines (page/src/designs/chebyshev.js).


def nodes(low: float, high: float, count: int) -> np.ndarray:
    """Return the points between two ends, (count,), rising. ``count`` is at least 2."""
    cosines = np.cos(np.pi * np.arange(count - 1, -1, -1) / (count - 1))
    points = 0.5 * (low + high) + 0.5 * (high - low) * cosines
    points[[0, -1]] = low, high
    return points


def weights(x: float, points: np.ndarray) -> np.ndarray:
    """Return the weight of each node at ``x``, (count,); their sum is 1."""
    away = x - points
    if (hit := np.flatnonzero(np.abs(away) <= 1e-14 * np.ptp(points))).size:  # nearer, the quotients overflow
        return np.eye(len(points))[hit[0]]
    signs = (-1.0) ** np.arange(len(points))
    signs[[0, -1]] *= 0.5
    raw = signs / away
    return raw / raw.sum()


def tensor_weights(place: Sequence[float], axes: Sequence[np.ndarray]) -> np.ndarray:
    """Return the weight of each design of the grid, (product of counts,), the last axis fastest."""
    out = np.ones(1)
    for x, points in zip(place, axes, strict=True):
        out = np.multiply.outer(out, weights(x, points)).ravel()
    return out


def grid(axes: Sequence[np.ndarray]) -> list[tuple[float, ...]]:
    """Return all designs, the last axis running fastest."""
    return [tuple(map(float, place)) for place in itertools.product(*axes)]


# Numbers of Params that a page offers, and the ends between which they move.


WIDEST = 0.6, 1.5
"""Multiples of a number's value: a page offers no more than this."""
NARROWER = 0.7
TRIES = 7
NUDGE = 0.02
"""Part of its range by which a number is moved to see what it does."""
FELT = 1e-3
"""Parts of the machine's size or of its largest effort: what moves less is no main number."""


@dataclass(frozen=True)
class Axis:
    """Number of Params between two ends."""

    number: Number
    low: float
    high: float

    @property
    def name(self) -> str:
        """Name in Params."""
        return self.number.name

    def narrower(self) -> Axis:
        """Return an axis whose ends are nearer to the number's own value."""
        value = self.number.value
        return replace(self, low=value + NARROWER * (self.low - value), high=value + NARROWER * (self.high - value))


def axes_of(solved: Solved, numbers: list[Number], most: int) -> list[Axis]:
    """Return at most ``most`` main numbers.

    First come those that move the mechanism most, then those that change its efforts most.
    """
    felt: list[tuple[float, float, Axis]] = []
    for number in numbers:
        axis = _widest(number)
        if axis is None or solved.is_late:
            continue
        moved = solved.numbers_at({number.name: number.value + NUDGE * (number.high - number.low)})
        if moved is None:
            continue
        places, efforts = solved.away(moved, solved.usual)
        if max(places, efforts) > FELT:
            felt.append((places if places > FELT else 0.0, efforts, axis))
    felt.sort(key=lambda each: each[:2], reverse=True)
    fitting = (_that_solves(solved, axis) for _, _, axis in felt)
    out = []
    for axis in fitting:
        if axis is not None:
            out.append(axis)
        if len(out) == most:
            break
    return out


def _widest(number: Number) -> Axis | None:
    """Return the number's own range, within WIDEST.

    It is None for whole numbers and zeros, which have no multiples.
    """
    if number.whole or number.value == 0:
        return None
    ends = sorted(factor * number.value for factor in WIDEST)
    return Axis(number, max(number.low, ends[0]), min(number.high, ends[1]))


def _that_solves(solved: Solved, axis: Axis) -> Axis | None:
    """Return ends that both solve while all other numbers stay; None without such."""
    for _ in range(TRIES):
        if all(solved.numbers_at({axis.name: end}) is not None for end in (axis.low, axis.high)):
            return axis
        axis = axis.narrower()
    return None


SHAPES = ((3, 5), (3, 4), (2, 7), (2, 5), (1, 9))
"""Numbers and nodes of each: the first that is exact enough and small enough is taken."""
LARGEST = 1_600_000
"""Bytes of the table, compressed."""
PLACES, EFFORTS = 4e-3, 0.06
"""Largest errors between the nodes, relative to the machine's size and to its largest effort."""
CHECKS = 6
"""Designs between the nodes that are solved and compared."""
NARROWINGS = 4
PATIENCE = 150.0
"""Seconds that the designs of a machine may take."""
STEPS = 65535


@dataclass(frozen=True)
class Table:
    """Table for the page, with its errors relative to the machine's size and largest effort."""

    content: bytes
    names: tuple[str, ...]
    designs: int
    places: float
    efforts: float


def table_of(author: Author) -> Table | None:
    """Return the table of a mechanism; None if no number can be moved smoothly. Raises UserError."""
    solved = Solved(author, PATIENCE)
    every = axes_of(solved, numbers_of(author.params), most=max(count for count, _ in SHAPES))
    words = described(author)
    for count, per_axis in SHAPES:
        if len(every) < count:
            continue
        axes = every[:count]
        for _ in range(NARROWINGS):
            made = _filled(solved, axes, per_axis, words)
            if made is not None and len(made.content) <= LARGEST:
                return made
            if made is not None or solved.is_late:
                break
            axes = [axis.narrower() for axis in axes]
    return None


def _filled(solved: Solved, axes: list[Axis], per_axis: int, words: dict[str, dict[str, str]]) -> Table | None:
    """Return the designs on the grid; None if one is not solved or interpolation is not exact enough."""
    points = [nodes(axis.low, axis.high, per_axis) for axis in axes]
    names = [axis.name for axis in axes]
    rows = []
    for place in grid(points):
        row = solved.numbers_at(dict(zip(names, place, strict=True)))
        if row is None:
            return None
        rows.append(row)
    designs = np.array(rows)
    low, span, codes = _quantised(designs)
    worst = [0.0, 0.0]
    for part in _between(names):
        place = [axis.low + x * (axis.high - axis.low) for axis, x in zip(axes, part, strict=True)]
        exact = solved.numbers_at(dict(zip(names, place, strict=True)))
        if exact is None:
            return None
        shown = low + span / STEPS * (tensor_weights(place, points) @ codes)
        worst = [max(pair) for pair in zip(worst, solved.away(shown, exact), strict=True)]
        if worst[0] > PLACES or worst[1] > EFFORTS:
            return None
    content = encode(_document(solved, axes, points, words, (low, span, codes), worst))
    return Table(content, tuple(names), len(rows), *worst)


def _quantised(designs: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return least value and span of each number over all designs, (N,), and codes 0..STEPS, (D, N)."""
    low = designs.min(axis=0).astype(np.float32).astype(float)
    span = (designs.max(axis=0) - low).astype(np.float32).astype(float)
    span = np.where(span > 1e-9 * np.abs(low), span, 0.0)
    codes = np.round((designs - low) / np.where(span > 0, span, 1.0) * STEPS)
    return low, span, np.clip(codes, 0, STEPS)


def _between(names: list[str]) -> np.ndarray:
    """Return designs inside the grid, (CHECKS, numbers), relative to each range; always the same."""
    seed = int.from_bytes(hashlib.sha256(" ".join(names).encode()).digest()[:8], "little")
    return np.random.Generator(np.random.Philox(seed)).uniform(0.03, 0.97, (CHECKS, len(names)))


def _document(
    solved: Solved,
    axes: list[Axis],
    points: list[np.ndarray],
    words: dict[str, dict[str, str]],
    numbers: tuple[np.ndarray, np.ndarray, np.ndarray],
    worst: list[float],
) -> dict[str, Any]:
    """Return the document of the table that the page reads.

    It has ``numbers`` as the sliders take them, ``nodes`` of each, and ``form``, a payload without its numbers. These
    are in their order low, and those that are used, low + span * (weights of the designs times codes) / 65535.
    """
    low, span, codes = numbers
    used = np.flatnonzero(span > 0)
    return {
        "numbers": [
            {
                "name": axis.name,
                "value": axis.number.value,
                "low": axis.low,
                "high": axis.high,
                "step": min(axis.number.step, (axis.high - axis.low) / 100),
                "whole": False,
                **words[axis.name],
            }
            for axis in axes
        ],
        "nodes": [list(map(float, each)) for each in points],
        "form": form(solved.payload),
        "low": low.astype(np.float32),
        "span": span[used].astype(np.float32),
        "used": used.astype(np.uint32),
        "codes": codes[:, used].astype(np.uint16),
        "places": worst[0] * solved.size,
        "efforts": worst[1],
    }
