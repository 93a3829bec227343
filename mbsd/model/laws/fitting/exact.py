"""A law whose derivatives are given, as quintic pieces through f, f', f'' at their ends.

The derivatives are compared with f between the times of look.py first (derivatives.py). A piece is met where it agrees
with the law in its middle, where its error is largest, and with f'' at those times; else it is halved. Pieces that
shrink onto a point tell where f'' jumps: the span is cut there, as rounding spoils f'' of narrow pieces. Where f at
both ends agrees with f' and f'' but for rounding, their quartic is taken, so that f'' does not show the rounding of f.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.model.laws.fitting.cuts import Cut, finest, given_cuts, merged, roots, without_edges
from mbsd.model.laws.fitting.derivatives import (
    Rows,
    refuse_between,
    refuse_derivatives,
    refuse_rows_of_pieces,
    sizes,
    stands_still,
)
from mbsd.model.laws.fitting.leaves import FAINT, JUMP, KINK, POINT, ROUNDING, USUAL, refuse_jump, refuse_kink
from mbsd.model.laws.fitting.sampled import Sampled
from mbsd.model.laws.numbers import Compiled, pieces, quintic_coefficients

TOLERANCE = np.array([1e-12, 1e-10, 1e-9])
"""Tolerances of f, f' and f'', relative to their size."""
MOST_TIMES = 600_000
CLOSEST = 1e-12
"""Part of the span within which a jump of f'' is found."""
CANCELLED = 64 * np.finfo(float).eps
"""Part of the largest f' and f'' that is rounding where their terms cancel, as at the ends of a 3-4-5 rise and beyond
(31 eps of a 3-4-5, 140 of a 4-5-6-7 polynomial), or where sin(2 pi) is -2.4e-16 in a dwell.
"""
ROUNDS = 4
EPSILON = float(np.finfo(float).eps)


def exact_pieces(
    law: Rows, first: float, last: float, breaks: Sequence[float], looks: np.ndarray, seen: np.ndarray
) -> Compiled:
    """``law`` gives (n, 3) at times (n,); ``seen`` (n, 3): what it gives at the times ``looks``.

    Raises ModelError where f or f' jumps, and where the derivatives are not those of f.
    """
    if stands_still(looks, seen):
        return pieces(np.array([first, last]), np.array([[seen[0, 0], 0.0, 0.0, 0.0, 0.0, 0.0]]))
    refuse_between(law, looks, seen)
    sampled = Sampled(law)
    all_cuts = given_cuts(breaks, first, last)
    for _ in range(ROUNDS):
        cuts, begin, end = without_edges(all_cuts, first, last)
        rows, new = _refined(sampled, (first, last), begin, end, cuts, looks, seen)
        edges = [begin, end, *(edge for cut in cuts for edge in (cut.left, cut.right))]
        new = [cut for cut in new if not any(cut.left <= edge <= cut.right for edge in edges)]
        if not new:
            break
        all_cuts = merged([*all_cuts, *new], 4 * finest(first, last))
    at, left, right = rows
    for cut in cuts:
        k = int(np.searchsorted(at[:, 0], cut.at))
        refuse_jump(cut.at, left[k, 0] - right[k - 1, 0], JUMP * float(np.ptp(left[:, 0])))
        refuse_kink(cut.at, left[k, 1] - right[k - 1, 1], KINK * float(np.abs(left[:, 1]).max()))
    whole = float(np.ptp(seen[:, 0]))
    coefficients = _quintics(at[:, 1] - at[:, 0], left, right, max(abs(first), abs(last)), whole)
    return pieces(np.append(at[:, 0], at[-1, 1]), coefficients)


def _quintics(h: np.ndarray, left: np.ndarray, right: np.ndarray, far: float, whole: float) -> np.ndarray:
    """Return (n, 6) quintics over widths h (n,), from f, f', f'' (n, 3) at both ends.

    ``far`` (s): latest time, ``whole``: range of f.
    """
    slope, bend = (right[:, 1] - left[:, 1] - h * left[:, 2]) * h, (right[:, 2] - left[:, 2]) * h**2
    rise = right[:, 0] - left[:, 0] - h * left[:, 1] - h**2 * left[:, 2] / 2
    beside = np.maximum(np.abs(left), np.abs(right))
    by_rates = slope / 2 - bend / 12
    rounded = np.abs(rise - by_rates) <= EPSILON * (beside[:, 0] + beside[:, 1] * far) + CANCELLED * whole
    return quintic_coefficients(h, left, np.where(rounded, by_rates, rise), slope, bend)


def _at(coefficients: np.ndarray, s: np.ndarray) -> np.ndarray:
    """(n, 3) of pieces (n, 6) at s (n,) from their begins."""
    powers = s[:, None] ** np.arange(6)
    order = np.arange(1, 6)
    slopes = coefficients[:, 1:] * order
    bends = slopes[:, 1:] * order[:-1]
    return np.stack(
        [(coefficients * powers).sum(1), (slopes * powers[:, :5]).sum(1), (bends * powers[:, :4]).sum(1)], axis=1
    )


def _refined(
    sampled: Sampled,
    span: tuple[float, float],
    first: float,
    last: float,
    cuts: list[Cut],
    looks: np.ndarray,
    seen: np.ndarray,
) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], list[Cut]]:
    """Begin and end (n, 2), both ends' values (n, 3), and points that pieces shrink onto."""
    long = span[1] - span[0]
    rows, stretch = roots(span, first, last, cuts)
    at = rows
    left, right = sampled(at[:, 0]), sampled(at[:, 1])
    size = np.maximum(np.abs(left), np.abs(right)).max(axis=0)
    range_ = float(np.ptp(np.append(left[:, 0], right[:, 0])))
    peak, whole = sizes(looks, seen), max(range_, float(np.ptp(seen[:, 0])))
    seen = seen[:, 2]
    usual = max(float(np.quantile(np.abs(seen), USUAL)), FAINT * range_ / long**2)
    far = max(map(abs, span))
    done, points = [], []
    above = np.zeros(len(at))
    depth = 0
    while len(at):
        width = at[:, 1] - at[:, 0]
        middle = at.mean(axis=1)
        real = sampled(middle)
        size = np.maximum(size, np.abs(real).max(axis=0))
        coefficients = _quintics(width, left, right, far, whole)
        bend = np.maximum.reduce([np.abs(left[:, 2]), np.abs(right[:, 2]), np.abs(real[:, 2]), above])
        scale = np.stack([np.full(len(at), size[0]), np.full(len(at), size[1]), np.maximum(bend, usual)], axis=1)
        value, slope = np.abs(real[:, 0]) + size[1] * far, np.abs(real[:, 1]) + np.maximum(bend, usual) * far
        rounding = ROUNDING * np.stack([value, slope, np.abs(real[:, 2]) + slope / width], axis=1)
        peak = np.maximum(peak, size)
        allowed = TOLERANCE * scale
        rounding[:, 2] = np.maximum(rounding[:, 2], CANCELLED * (peak[2] + peak[1] / width))
        met = (np.abs(_at(coefficients, width / 2) - real) <= np.maximum(allowed, rounding)).all(axis=1)
        low, high = np.searchsorted(looks, at[:, 0], "right"), np.searchsorted(looks, at[:, 1])
        count = np.maximum(high - low, 0)
        piece = np.repeat(np.arange(len(at)), count)
        which = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count) + np.repeat(low, count)
        off = np.abs(_at(coefficients[piece], looks[which] - at[piece, 0])[:, 2] - seen[which])
        noise = np.maximum(allowed, rounding)[piece, 2] + ROUNDING * np.abs(seen[which]) * far / long
        met[piece[off > 4 * noise]] = False
        narrow = width <= max(finest(*span), CLOSEST * long)
        points += [Cut(*at[k, [0, 0, 1]]) for k in np.flatnonzero(~met & narrow)]
        for k in np.flatnonzero(~met & (width < POINT * long)):
            refuse_jump(float(at[k, 0]), right[k, 0] - left[k, 0], max(JUMP * whole, 10 * peak[1] * width[k]))
            refuse_kink(float(at[k, 0]), right[k, 1] - left[k, 1], max(KINK * peak[1], 10 * bend[k] * width[k]))
        failing = at[~met], left[~met], real[~met], right[~met]
        refuse_rows_of_pieces(sampled, *failing, peak, 2 * len(failing[0]) > len(rows) << depth)
        if sampled.count > MOST_TIMES:
            refuse_derivatives(*failing, peak)
            raise ModelError(
                f"function: the law with its derivatives does not settle near t = {failing[0][0, 0]:.6g} s, after "
                f"{MOST_TIMES} times: it scatters, or what it does is too short; give a shorter span, or breaks="
            )
        keep = met | narrow
        done.append([part[keep] for part in (at, left, right, stretch)])
        at, left, right, real, stretch, above = (
            part[~keep] for part in (at, left, right, real, stretch, np.abs(real[:, 2]))
        )
        middle = at.mean(axis=1)
        at = np.stack([np.stack([at[:, 0], middle], 1), np.stack([middle, at[:, 1]], 1)], axis=1).reshape(-1, 2)
        left = np.stack([left, real], axis=1).reshape(-1, 3)
        right = np.stack([real, right], axis=1).reshape(-1, 3)
        stretch, above = np.repeat(stretch, 2), np.repeat(above, 2)
        depth += 1
    at, left, right, stretch = (np.concatenate(parts) for parts in zip(*done, strict=True))
    order = np.argsort(at[:, 0], kind="stable")
    at, left, right, stretch = at[order], left[order], right[order], stretch[order]
    for k, cut in enumerate(cuts):
        before, after = np.flatnonzero(stretch == k)[-1], np.flatnonzero(stretch == k + 1)[0]
        right[before] = _continued(right[before], cut.at - at[before, 1])
        left[after] = _continued(left[after], cut.at - at[after, 0])
        at[before, 1] = at[after, 0] = cut.at
    return (at, left, right), points


def _continued(row: np.ndarray, by: float) -> np.ndarray:
    """f, f', f'' (3,) a little (s) later or earlier."""
    f, slope, bend = row
    return np.array([f + by * (slope + by * bend / 2), slope + by * bend, bend])
