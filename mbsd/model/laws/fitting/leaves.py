"""Values of a law on ever finer pieces, polynomials of degree 8 through nine nodes, until they fit.

A piece is met where its last two Chebyshev coefficients and its distance to the law at the times that are looked at
as well (sampling.py) are small enough; else it is halved. What counts for a driver is f'':
c T_8((t - middle) / (w / 2)) has f'' = 1344 c (2 / w)^2 at its ends. What counts for a load is f.

The span is cut where the law or a derivative jumps. A cut is known as a bracket l <= b <= r: the law is smooth up to l
and from r on, and what is fitted on either side is continued to b.

Source: Trefethen, Approximation Theory and Approximation Practice, 2013, ch. 3.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from mbsd.base.errors import ModelError
from mbsd.model.laws.fitting.sampling import Sampled

ROOTS = 16
"""First pieces of a span without cuts."""
STUB = 0.25
"""A first piece shorter than this part of the usual ones is joined with its neighbour."""
BESIDE = 1e-13
"""Distance (of the span) from a break of its author at which a law is evaluated."""
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


DEGREE = 8
_NODES = np.linspace(-1.0, 1.0, DEGREE + 1)
TO_CHEBYSHEV = np.linalg.inv(chebyshev.chebvander(_NODES, DEGREE))
"""(9, 9) from values at the nodes to coefficients."""
SLOPE = np.stack([chebyshev.chebval(_NODES, chebyshev.chebder(row)) for row in TO_CHEBYSHEV.T], axis=1)
BEND = np.stack([chebyshev.chebval(_NODES, chebyshev.chebder(row, 2)) for row in TO_CHEBYSHEV.T], axis=1)
"""(9, 9) from values at the nodes to the derivatives there, by x in -1 .. 1."""
BEND_OF_LAST = 1344.0
"""T_8'' at the ends."""
BEND_TOLERANCE, VALUE_TOLERANCE = 1e-8, 1e-11
"""Tolerances of f'' of a driver's law, of f of a load's law, relative to what is usual nearby."""
EPSILON = float(np.finfo(float).eps)
ROUNDING = 8 * EPSILON
LOOSER = 16.0
"""A law may be this many tolerances off between the nodes."""
USUAL = 0.9
"""Share of the first pieces whose f'' counts as usual."""
FAINT = 1e-3
"""Part of (range of f) / span^2 below which f'' is none."""
MOST_CALLS = 500_000
HIDDEN = 100.0
"""Rounding that may hide this many tolerances of f'' shows that a piece shrank onto a point."""
SCATTER, LEVEL = 0.5, 4
SMALL, SMALL_LOAD = 1e-3, 1e-6
"""Coefficients that fall by less after so many halvings, and are below this part of f, are scatter of f."""
POINT = 1e-9
"""A piece narrower than this part of the span distinguishes a jump of f or f' from one of f''."""
KINK, JUMP = 1e-4, 1e-7
"""Jumps of f' and f, of their usual size, that a driver cannot follow."""


@dataclass
class Leaves:
    """Pieces in order of time."""

    begin: np.ndarray
    end: np.ndarray
    """(n,) s"""
    values: np.ndarray
    """(n, 9) at the nodes."""
    stretch: np.ndarray
    """(n,) between which cuts."""
    depth: np.ndarray
    """(n,) how often halved."""
    last: np.ndarray
    """(n,) size of the last two coefficients."""
    rounding: np.ndarray
    """(n,) of f."""
    scale: np.ndarray
    """(n,) of f'' nearby."""
    rough: np.ndarray
    """(n,) whether rounding hides what is not met yet."""
    stuck: np.ndarray
    """(n,) whether the narrowest piece does not meet the law."""

    @property
    def width(self) -> np.ndarray:
        """(n,) s"""
        return self.end - self.begin


class Tree:
    """Pieces of a law over ``span`` (s) between ``cuts``; ``looks``: times and what f is there."""

    def __init__(
        self,
        sampled: Sampled,
        span: tuple[float, float],
        cuts: list[Cut],
        looks: tuple[np.ndarray, np.ndarray],
        load: bool,
        tolerance: float,
        most_calls: int,
    ) -> None:
        self.sampled, self.span, self.load = sampled, span, load
        self.tolerance, self.most_calls = tolerance, most_calls
        self.cuts, self.begin, self.end = without_edges(cuts, *span)
        inside = np.ones(len(looks[0]), bool)
        for cut in cuts:
            inside &= (looks[0] < cut.left) | (looks[0] > cut.right)
        self.looks, self.seen = looks[0][inside], looks[1][inside]
        long = span[1] - span[0]
        self.range = float(np.ptp(self.seen))
        self.size = float(np.abs(self.seen).max())
        self.rate = float(np.quantile(np.abs(np.diff(self.seen)) / np.diff(self.looks), USUAL))
        self.shift = ROUNDING * self.rate * max(map(abs, span))
        self.steepest = max(self.rate, self.range / long)
        self.faint = FAINT * self.range / long**2
        self.overrun, self.scatter, self.scatter_at = False, 0.0, 0.0
        self.before = math.inf

    def refined(self) -> Leaves:
        """All pieces."""
        rows, stretch = roots(self.span, self.begin, self.end, self.cuts)
        begin, end = rows.T
        nodes = begin[:, None] + (end - begin)[:, None] * (np.arange(DEGREE + 1) / DEGREE)
        nodes[:, -1] = end  # rounding must not reach beyond a jump
        values = self.sampled(nodes)
        above, done, depth = np.zeros((len(begin), 2)), [], 0
        above[:, 1] = np.abs(values).max(axis=1)
        usual, first_count = None, len(begin)
        while len(begin):
            width = end - begin
            coefficients = values @ TO_CHEBYSHEV.T
            tail = np.abs(coefficients[:, -2:]).max(axis=1)
            bend = np.abs(values @ BEND.T).max(axis=1) * (2 / width) ** 2
            usual = float(np.quantile(bend, USUAL)) if usual is None else usual
            scale = np.maximum.reduce([bend, above[:, 0], np.full(len(bend), max(usual, self.faint))])
            if len(begin) == first_count << depth:
                self._look_for_scatter(depth, begin, tail)
            steepness = np.abs(np.diff(values, axis=1)).max(axis=1) * DEGREE / width
            shift = np.full(len(begin), self.shift)
            if not self.load:  # which does not jump
                shift = np.maximum(shift, EPSILON * steepness * np.maximum(np.abs(begin), np.abs(end)))
            rounding = ROUNDING * above[:, 1] + shift + 2 * self.scatter
            if self.load:
                allowed = np.full(len(begin), self.tolerance * self.size)
            else:
                allowed = BEND_TOLERANCE * scale * (width / 2) ** 2 / BEND_OF_LAST
            enough = np.maximum(allowed, rounding)
            met = (tail <= enough) & ~self._missed(begin, end, coefficients, LOOSER * enough)
            if met.any():
                self.steepest = max(self.steepest, float(steepness[met].max()))
            if not self.load:
                self._check_jumps(begin[~met], width[~met], values[~met])
            narrow = width <= finest(*self.span)
            if self.sampled.count + DEGREE * (~met & ~narrow).sum() > self.most_calls:
                self.overrun = True
                narrow[:] = True
            keep = met | narrow
            rough = met & (tail > allowed) & (rounding > HIDDEN * allowed) & (depth > 0)
            parts = begin, end, values, stretch, np.full(len(begin), depth), tail, rounding, scale, rough, ~met
            done.append([part[keep] for part in parts])
            above[:, 0] = bend
            begin, end, values, stretch, above = (part[~keep] for part in (begin, end, values, stretch, above))
            begin, end, values, stretch, above = self._halved(begin, end, values, stretch, above)
            depth += 1
        whole = [np.concatenate(parts) for parts in zip(*done, strict=True)]
        order = np.argsort(whole[0], kind="stable")
        return Leaves(*(part[order] for part in whole))

    def _look_for_scatter(self, depth: int, begin: np.ndarray, tail: np.ndarray) -> None:
        """Record scatter if all pieces of this level are off as much as those of the last one.

        No halving cures that. Raises ModelError for the law of a driver.
        """
        level = float(np.median(tail))
        small = (SMALL_LOAD if self.load else SMALL) * self.size
        if depth >= LEVEL and SCATTER * self.before < level < small and level > 10 * ROUNDING * self.size:
            self.scatter = float(tail.max())
            self.scatter_at = float(begin[np.argmax(tail)])
            if not self.load:
                raise ModelError(
                    f"function: the law is not smooth: it scatters by {self.scatter:.2g} or has corners all along, so "
                    "f'' cannot be found. Give its derivatives df and ddf, or smooth it with recorded(...)"
                )
        self.before = level

    def _halved(
        self, begin: np.ndarray, end: np.ndarray, values: np.ndarray, stretch: np.ndarray, above: np.ndarray
    ) -> tuple[np.ndarray, ...]:
        middle = (begin + end) / 2
        begins, ends = np.stack([begin, middle], axis=1).ravel(), np.stack([middle, end], axis=1).ravel()
        out = np.zeros((len(begins), DEGREE + 1))
        out[:, ::2] = np.stack([values[:, :5], values[:, 4:]], axis=1).reshape(-1, 5)
        if len(begins):
            out[:, 1::2] = self.sampled(begins[:, None] + (ends - begins)[:, None] * (np.arange(1, 8, 2) / DEGREE))
        return begins, ends, out, np.repeat(stretch, 2), np.repeat(above, 2, axis=0)

    def _missed(self, begin: np.ndarray, end: np.ndarray, coefficients: np.ndarray, enough: np.ndarray) -> np.ndarray:
        """(n,) whether a piece is off the law at one of the times looked at."""
        out = np.zeros(len(begin), bool)
        low, high = np.searchsorted(self.looks, begin), np.searchsorted(self.looks, end)
        count = np.maximum(high - low, 0)
        if not count.sum():
            return out
        piece = np.repeat(np.arange(len(begin)), count)
        which = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count) + np.repeat(low, count)
        x = 2 * (self.looks[which] - begin[piece]) / (end - begin)[piece] - 1
        off = (chebyshev.chebvander(x, DEGREE) * coefficients[piece]).sum(axis=1) - self.seen[which]
        out[piece[np.abs(off) > enough[piece]]] = True
        return out

    def _check_jumps(self, begin: np.ndarray, width: np.ndarray, values: np.ndarray) -> None:
        """Raise ModelError where the law of a driver jumps or has a kink."""
        for k in np.flatnonzero(width < POINT * (self.span[1] - self.span[0])):
            early, late = values[k, 4] - values[k, 0], values[k, 8] - values[k, 4]
            check_jump(float(begin[k]), early + late, max(JUMP * self.range, 10 * self.steepest * width[k]))
            check_kink(float(begin[k]), 2 * (late - early) / width[k], KINK * self.steepest)


def check_jump(at: float, jump: float, allowed: float) -> None:
    """Raise ModelError for a jump of f that a driver cannot follow."""
    if abs(jump) > allowed:
        raise ModelError(
            f"function: the law jumps by {jump:.4g} at t = {at:.7g} s; a driver would need an infinite acceleration "
            "there. Let it rise within a short time, as cycloidal(...) does"
        )


def check_kink(at: float, kink: float, allowed: float) -> None:
    """Raise ModelError for a jump of f' that a driver cannot follow."""
    if abs(kink) > allowed:
        raise ModelError(
            f"function: the law is not smooth: its rate jumps by {kink:.4g} at t = {at:.7g} s, which needs an "
            "infinite acceleration of a driver. Round the corner, or use cycloidal(...), table(...) or recorded(...)"
        )
