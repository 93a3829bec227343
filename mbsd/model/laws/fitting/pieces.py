"""Quintic pieces of a fit (fit.py), through f, f' and f'' at nodes of its degree-8 polynomials.

A cut stands where f, or f' of a driver, is the same on both sides, which is known better than its bracket.

Where two polynomials meet, f' and f'' are means weighted by the square of their widths, as rounding falls with it. At a
cut both sides are continued to the same time. f and f' of a driver's law are continuous there, f'' may jump.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev

from mbsd.model.laws.fitting.fit import Fit
from mbsd.model.laws.fitting.leaves import (
    BEND,
    DEGREE,
    JUMP,
    KINK,
    SLOPE,
    TO_CHEBYSHEV,
    Leaves,
    refuse_jump,
    refuse_kink,
)
from mbsd.model.laws.numbers import Compiled, hermite_coefficients, pieces

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
        before[:], after[:] = _beside(fit, k, at)
        step, kink = after[0] - before[0], after[1] - before[1]
        if not load:
            refuse_jump(cut.at, step, JUMP * spread + 1e-12 * size)
            refuse_kink(cut.at, kink, KINK * rate)
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
    before, after = _beside(fit, k, cut.at)
    order = 0 if load else 1
    change = after[order + 1] - before[order + 1]
    at = cut.at - (after[order] - before[order]) / change if change else cut.at
    return at if cut.left <= at <= cut.right else cut.at


def _beside(fit: Fit, k: int, at: float) -> tuple[np.ndarray, np.ndarray]:
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
