"""A law as pieces (leaves.py) between cuts, where f or a derivative jumps.

Rounding bounds f'' of a narrow piece, so narrow pieces do not cure a jump of f or a derivative. Pieces that shrink onto
one point tell where it is: the span is cut there, and wide pieces on either side give f''.

Source: Pachon, Platte, Trefethen 2010, IMA J. Numer. Anal. 30 (splitting at a point found by halving).

The result is quintic pieces through f, f' and f'' at nodes of the polynomials of degree 8. A cut stands where f, or f'
of a driver, is the same on both sides, which is known better than its bracket. Where two polynomials meet, f' and f''
are means weighted by the square of their widths, as rounding falls with it. At a cut both sides are continued to the
same time. f and f' of a driver's law are continuous there, f'' may jump.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from mbsd.model.laws.fitting.leaves import (
    BEND,
    BEND_OF_LAST,
    BEND_TOLERANCE,
    DEGREE,
    JUMP,
    KINK,
    MOST_CALLS,
    SLOPE,
    TO_CHEBYSHEV,
    VALUE_TOLERANCE,
    Cut,
    Leaves,
    Tree,
    check_jump,
    check_kink,
    finest,
    merged,
)
from mbsd.model.laws.fitting.sampling import Sampled
from mbsd.model.laws.numbers import Compiled, hermite_coefficients, pieces

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
    """True if it took too many calls to meet all of it."""


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


STEP, AT_ONCE = 1e-9, 1e-11
"""Fractions of the size of a load and of the span: what counts as a jump."""


def fit_pieces(fit: Fit, load: bool) -> tuple[Compiled, list[float], list[float]]:
    """As kernels evaluate it, the times (s) of the cuts, and those where f jumps.

    Raises ModelError where the law of a driver jumps or has a kink.
    """
    nodes, samples = _stretches(fit)
    whole = np.concatenate(samples)
    size, spread, rate = float(np.abs(whole[:, 0]).max()), float(np.ptp(whole[:, 0])), float(np.abs(whole[:, 1]).max())
    cuts, jumps = [], []
    for k, cut in enumerate(fit.cuts):
        at = _placed(fit, k, load)
        nodes[k][-1] = nodes[k + 1][0] = at
        before, after = samples[k][-1], samples[k + 1][0]
        before[:], after[:] = _values_beside(fit, k, at)
        step, kink = after[0] - before[0], after[1] - before[1]
        if not load:
            check_jump(cut.at, step, JUMP * spread + 1e-12 * size)
            check_kink(cut.at, kink, KINK * rate)
            before[:2] = after[:2] = (before[:2] + after[:2]) / 2
        elif abs(step) > STEP * size and cut.right - cut.left < AT_ONCE * (nodes[-1][-1] - nodes[0][0]):
            jumps.append(float(at))
        cuts.append(float(at))
    breaks = np.concatenate([part[:-1] for part in nodes] + [nodes[-1][-1:]])
    rows = [hermite_coefficients(np.diff(at), part[:-1], part[1:]) for at, part in zip(nodes, samples, strict=True)]
    return pieces(breaks, np.concatenate(rows)), cuts, jumps


def _stretches(fit: Fit) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Nodes (n,) in s of each stretch between cuts, and f, f', f'' (n, 3) there."""
    leaves = fit.leaves
    width = leaves.width
    slope = leaves.values @ SLOPE.T * (2 / width)[:, None]
    bend = leaves.values @ BEND.T * ((2 / width) ** 2)[:, None]
    share = np.arange(DEGREE + 1) / DEGREE
    times, rows = [], []
    for k in range(len(fit.cuts) + 1):
        mine = np.flatnonzero(leaves.stretch == k)
        both = np.stack([leaves.values[mine], slope[mine], bend[mine]], axis=-1)
        weight = width[mine] ** 2
        left = (weight[:-1] / (weight[:-1] + weight[1:]))[:, None]
        both[:-1, -1] = both[1:, 0] = left * both[:-1, -1] + (1 - left) * both[1:, 0]
        at = leaves.begin[mine][:, None] + width[mine][:, None] * share
        times.append(np.append(at[:, :-1].ravel(), leaves.end[mine[-1]]))
        rows.append(np.append(both[:, :-1].reshape(-1, 3), both[-1:, -1], axis=0))
    return times, rows


def _placed(fit: Fit, k: int, load: bool) -> float:
    """Cut k (s) where f, or f' of a driver, is the same on both sides, if that is within its bracket."""
    cut = fit.cuts[k]
    before, after = _values_beside(fit, k, cut.at)
    order = 0 if load else 1
    change = after[order + 1] - before[order + 1]
    at = cut.at - (after[order] - before[order]) / change if change else cut.at
    return at if cut.left <= at <= cut.right else cut.at


def _values_beside(fit: Fit, k: int, at: float) -> tuple[np.ndarray, np.ndarray]:
    """f, f', f'' before and after cut k, continued to ``at`` (s)."""
    leaves = fit.leaves
    last, first = np.flatnonzero(leaves.stretch == k)[-1], np.flatnonzero(leaves.stretch == k + 1)[0]
    return _continued(leaves, last, at), _continued(leaves, first, at)


def _continued(leaves: Leaves, k: int, at: float) -> np.ndarray:
    """f, f', f'' of piece k at a time (s) on or beside it."""
    width = leaves.end[k] - leaves.begin[k]
    coefficients, x = TO_CHEBYSHEV @ leaves.values[k], 2 * (at - leaves.begin[k]) / width - 1
    return np.array(
        [float(chebyshev.chebval(x, chebyshev.chebder(coefficients, m))) * (2 / width) ** m for m in range(3)]
    )
