"""A law as pieces (leaves.py) between cuts, where f or a derivative jumps.

Rounding bounds f'' of a narrow piece, so narrow pieces do not cure a jump of f or a derivative. Pieces that shrink onto
one point tell where it is: the span is cut there, and wide pieces on either side give f''.

Source: Pachon, Platte, Trefethen 2010, IMA J. Numer. Anal. 30 (splitting at a point found by halving).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.model.laws.fitting.cuts import Cut, finest, merged
from mbsd.model.laws.fitting.leaves import (
    BEND,
    BEND_OF_LAST,
    BEND_TOLERANCE,
    MOST_CALLS,
    SLOPE,
    VALUE_TOLERANCE,
    Leaves,
    Tree,
)
from mbsd.model.laws.fitting.sampled import Sampled

CORNER = 1e3
"""Times the tolerance or rounding: mismatch of f' or f'' of two pieces where they meet that is none of the fit."""
DEEP = 14
"""Halvings of a load's piece that make a point likely."""
ASIDE, GROWN = 3, 4.0
"""Towards a point pieces fall by more than the second number over as many as the first."""
BRIEF = 1e-6
"""Part of the span: longer cuts that reach the last ones are left to rounding."""
ROUNDS = 8
UNSURE = 1e-3
"""The fraction of f'' nearby that rounding may hide before it is reported."""


@dataclass
class Fit:
    """A law as pieces between cuts."""

    leaves: Leaves
    cuts: list[Cut]
    size: float
    """Size of f."""
    missed: float = 0.0
    """Size of what could not be met, of f or, of a driver, of f'', and where (s)."""
    missed_at: float = 0.0
    overrun: bool = False
    """Whether it took too many calls to meet all of it."""


def fit(
    sampled: Sampled,
    first: float,
    last: float,
    cuts: Sequence[Cut],
    looks: np.ndarray,
    load: bool,
    tolerance: float = VALUE_TOLERANCE,
    most_calls: int = MOST_CALLS,
) -> Fit:
    """Return pieces of a law over ``first`` .. ``last`` (s), seen at ``looks``; ``load``: only f counts.

    ``looks`` are times (s).

    ``tolerance``: of a load, as part of its size. Raises ModelError where a driver's law jumps, has a kink or scatters.
    """
    sampled(np.array([first, last]))  # what fails everywhere fails at the begin
    all_cuts, seen = list(cuts), sampled.once(looks)
    for _ in range(ROUNDS):
        tree = Tree(sampled, (first, last), all_cuts, (looks, seen), load, tolerance, most_calls)
        leaves = tree.refined()
        if tree.overrun:
            worst = int(np.argmax(leaves.last * leaves.stuck))
            at = float(leaves.begin[worst] + leaves.end[worst]) / 2
            return Fit(leaves, tree.cuts, tree.size, float(leaves.last[worst]), at, True)
        new = _points(leaves, sampled, load) + _corners(leaves, load, tolerance * tree.size)
        known = [tree.begin, *(edge for cut in tree.cuts for edge in (cut.left, cut.right)), tree.end]
        new = [cut for cut in new if cut.right - cut.left < BRIEF * (last - first) or not _touches(cut, known)]
        if not new:
            break
        all_cuts = merged([*all_cuts, *new], 4 * finest(first, last))
    if load:
        return Fit(leaves, tree.cuts, tree.size, tree.scatter, tree.scatter_at)
    hidden = np.where(leaves.rough, BEND_OF_LAST * 4 * leaves.last / leaves.width**2, 0.0)
    worst = int(np.argmax(hidden / np.maximum(leaves.scale, 1e-300)))
    significant = hidden[worst] > UNSURE * leaves.scale[worst]
    return Fit(leaves, tree.cuts, tree.size, float(hidden[worst]) if significant else 0.0, float(leaves.begin[worst]))


def _touches(cut: Cut, edges: Sequence[float]) -> bool:
    return any(cut.left <= edge <= cut.right for edge in edges)


def _points(leaves: Leaves, sampled: Sampled, load: bool) -> list[Cut]:
    """Where pieces shrink onto one point."""
    hot = ((leaves.depth >= DEEP) if load else leaves.rough) | leaves.stuck
    out, k, width = [], 0, leaves.width
    while k < len(hot):
        e = k
        while e + 1 < len(hot) and hot[k] and hot[e + 1] and leaves.stretch[e + 1] == leaves.stretch[k]:
            e += 1
        mine = np.arange(k, e + 1)
        least = width[mine].min()
        narrow = mine[width[mine] == least]
        core = int(narrow[np.argmax(leaves.last[narrow])])
        if hot[k] and (leaves.stuck[core] or _shrinks(leaves, core)):
            out.append(_cut(leaves, sampled, max(core - 1, k), core, min(core + 1, e), load))
        k = e + 1
    return out


def _shrinks(leaves: Leaves, core: int) -> bool:
    """Return True if pieces grow away from this one on both sides, as halving towards a point leaves them."""
    mine = np.flatnonzero(leaves.stretch == leaves.stretch[core])
    beside = [k for k in (core - ASIDE, core + ASIDE) if mine[0] <= k <= mine[-1]]
    return all(leaves.width[k] >= GROWN * leaves.width[core] for k in beside)


def _corners(leaves: Leaves, load: bool, allowed: float) -> list[Cut]:
    """Where two pieces meet that are smooth each, but not together."""
    width = leaves.width
    slope = leaves.values @ SLOPE[[0, -1]].T * (2 / width)[:, None]
    bend = leaves.values @ BEND[[0, -1]].T * ((2 / width) ** 2)[:, None]
    least = np.minimum(width[:-1], width[1:])
    rounding = np.maximum(leaves.rounding[:-1], leaves.rounding[1:])
    kink = np.abs(slope[1:, 0] - slope[:-1, 1]) * least
    corner = kink > CORNER * np.maximum(rounding, allowed)
    if not load:
        scale = np.maximum(leaves.scale[:-1], leaves.scale[1:])
        step = np.abs(bend[1:, 0] - bend[:-1, 1])
        corner |= step > CORNER * (BEND_TOLERANCE * scale + BEND_OF_LAST * rounding / least**2)
    hot = leaves.stuck | leaves.rough | (leaves.depth >= DEEP if load else False)
    corner &= (leaves.stretch[1:] == leaves.stretch[:-1]) & ~hot[1:] & ~hot[:-1]
    return [Cut(at, at, at) for at in leaves.end[:-1][corner].tolist()]


def _cut(leaves: Leaves, sampled: Sampled, k: int, core: int, e: int, load: bool) -> Cut:
    """Return a cut around pieces k .. e, or of a jump between neighbouring numbers.

    The pieces shrink onto the piece ``core``.
    """
    same = leaves.stretch == leaves.stretch[core]
    begin, end = float(leaves.begin[same].min()), float(leaves.end[same].max())
    beside = float(leaves.width[core])
    low, high = float(leaves.begin[core]), float(leaves.end[core])
    if load and leaves.stuck[core]:
        before, after = leaves.values[core, 0], leaves.values[core, -1]
        while high > np.nextafter(low, high):
            middle = (low + high) / 2
            value = float(sampled(np.array([middle]))[0])
            if abs(value - before) <= abs(value - after):
                low = middle
            else:
                high = middle
        return Cut(low, high, high)
    left, right = max(float(leaves.begin[k]) - beside, begin), min(float(leaves.end[e]) + beside, end)
    return Cut(left, (low + high) / 2, right)
