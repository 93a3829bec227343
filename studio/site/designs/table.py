"""Designs of a page: solved on a grid, checked between its nodes, kept in 16 bits a number."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from render.view.document import encode
from studio.live.child.author import Author
from studio.live.child.described import described
from studio.live.numbers import numbers_of
from studio.site.designs import chebyshev
from studio.site.designs.choosing import Axis, axes_of
from studio.site.designs.leaves import form
from studio.site.designs.solved import Solved

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
    points = [chebyshev.nodes(axis.low, axis.high, per_axis) for axis in axes]
    names = [axis.name for axis in axes]
    rows = []
    for place in chebyshev.grid(points):
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
        shown = low + span / STEPS * (chebyshev.tensor_weights(place, points) @ codes)
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
