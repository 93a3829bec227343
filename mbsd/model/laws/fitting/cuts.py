"""Cuts of a law's span where the law or a derivative jumps, and the first pieces of a fit.

A cut is known as a bracket l <= b <= r: the law is smooth up to l and from r on, and what is fitted on either side is
continued to b.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

ROOTS = 16
"""First pieces of a span without cuts."""
STUB = 0.25
"""A first piece shorter than this part of the usual ones is joined with its neighbour."""
BESIDE = 1e-13
"""How far (of the span) a law is evaluated from a break that its author gave."""
CLOSE = 64
"""Neighbouring numbers within which a law is not looked at."""


@dataclass(frozen=True)
class Cut:
    """See the file; times in s."""

    left: float
    at: float
    right: float


def given_cuts(breaks: Sequence[float], first: float, last: float) -> list[Cut]:
    """Return the author's breaks between ``first`` and ``last`` (s)."""
    beside = BESIDE * (last - first) + 4 * finest(first, last) / CLOSE
    return [Cut(b - beside, b, b + beside) for b in sorted(set(breaks)) if first + 2 * beside < b < last - 2 * beside]


def finest(first: float, last: float) -> float:
    """Width (s) of the narrowest piece."""
    return CLOSE * float(np.spacing(max(abs(first), abs(last), last - first)))


def merged(cuts: Sequence[Cut], apart: float) -> list[Cut]:
    """In order; brackets nearer to each other than ``apart`` (s) become one."""
    out: list[Cut] = []
    for cut in sorted(cuts, key=lambda piece: piece.at):
        if out and cut.left - out[-1].right < apart:
            both = out.pop()
            narrow = min(both, cut, key=lambda piece: piece.right - piece.left)
            cut = Cut(min(both.left, cut.left), narrow.at, max(both.right, cut.right))
        out.append(cut)
    return out


def without_edges(cuts: list[Cut], first: float, last: float) -> tuple[list[Cut], float, float]:
    """Cuts at the very begin and end move these inwards (s): the law goes on to them as it is beside."""
    least, inner = 2 * finest(first, last), list(cuts)
    begin, end = first, last
    while inner and inner[0].left - begin < least:
        begin = inner.pop(0).right
    while inner and end - inner[-1].right < least:
        end = inner.pop().left
    return inner, begin, end


def roots(span: tuple[float, float], begin: float, end: float, cuts: Sequence[Cut]) -> tuple[np.ndarray, np.ndarray]:
    """Return begin and end (n, 2) of the first pieces from ``begin`` to ``end`` (s), and their stretches.

    The stretch (n,) is the one that each piece is in.

    A ``span`` (s) without cuts has ROOTS of them; a cut changes those beside it alone.
    """
    usual = (span[1] - span[0]) / ROOTS
    edges = span[0] + usual * np.arange(1, ROOTS)
    rows, stretches = [], []
    begins, ends = [begin, *(cut.right for cut in cuts)], [*(cut.left for cut in cuts), end]
    for k, (a, b) in enumerate(zip(begins, ends, strict=True)):
        inner = edges[(edges > a + STUB * usual) & (edges < b - STUB * usual)]
        nodes = np.concatenate([[a], inner, [b]])
        rows += pairwise(nodes)
        stretches += [k] * (len(nodes) - 1)
    return np.array(rows), np.array(stretches)
