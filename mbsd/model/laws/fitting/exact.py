"""A law whose derivatives are given, as quintic pieces through f, f', f'' at their ends.

First the derivatives are compared with f. Between two times a and b, h = b - a apart,

    (f_b - f_a) / h = (f'_a + f'_b) / 2 - h (f''_b - f''_a) / 12 + h^4 f^(5) / 720

holds between the times of sampling.py, also on a short stretch; f' is compared with the integral of a spline through
f''. Where it is off, f may change within the stretch unseen, so the worst ones are looked at more closely: a
derivative is wrong that is off in (nearly) every part of one.
Source: the Euler-Maclaurin formula, Abramowitz, Stegun, Handbook of Mathematical Functions, 23.1.30.

Then pieces are fitted. A piece is met where it agrees
with the law in its middle, where its error is largest, and with f'' at those times; else it is halved. Pieces that
shrink onto a point tell where f'' jumps: the span is cut there, as rounding spoils f'' of narrow pieces. Where f at
both ends agrees with f' and f'' but for rounding, their quartic is taken, so that f'' does not show the rounding of f.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.interpolate import CubicSpline

from mbsd.base.errors import ModelError
from mbsd.model.laws.fitting.leaves import (
    FAINT,
    JUMP,
    KINK,
    POINT,
    ROUNDING,
    USUAL,
    Cut,
    check_jump,
    check_kink,
    finest,
    given_cuts,
    merged,
    roots,
    without_edges,
)
from mbsd.model.laws.fitting.sampling import GOLDEN, Sampled
from mbsd.model.laws.numbers import Compiled, pieces, quintic_coefficients

DISAGREE = 1e-3
"""Part of f' by which df may differ from the slope of f, and ddf from that of df, where nothing else is known."""
DISAGREE_SMOOTH = 1e-6
"""The same on pieces on which the derivative is so straight (RESOLVED) that its mean is known."""
RESOLVED = 1e-2
"""Part of such a difference below which a derivative must be bent for it to count before all else is tried."""
CLOSE = 0.3
"""The same where it has to be off in all parts of a stretch."""
RUN = 16
"""Pieces in a row: right ones that are refined agree within rounding long before."""
WORST, PARTS, MOST_RIGHT = 8, 16, 1
"""Stretches that are looked at closely, the parts of each, and how many of them may be right."""

STILL = 1e-9
"""Part of f that its derivatives may seem to move it by where it stands still."""

Rows = Callable[[np.ndarray], np.ndarray]


class DerivativeError(ModelError):
    """A derivative that its author gave is not that of f."""


def check_between(law: Rows, looks: np.ndarray, rows: np.ndarray) -> None:
    """Raise DerivativeError if a derivative is wrong between ``looks`` (n,); ``rows`` (n, 3) are the law."""
    h, far = np.diff(looks), float(np.abs(looks).max())
    size = sizes(looks, rows)
    for order in (0, 1):
        slope = np.diff(rows[:, order]) / h
        if order == 0:
            given = (rows[1:, 1] + rows[:-1, 1]) / 2 - h * np.diff(rows[:, 2]) / 12
        else:
            given = np.diff(CubicSpline(looks, rows[:, 2]).antiderivative()(looks)) / h
        rounding = ROUNDING * (size[order] + size[order + 1] * far) / h
        off = np.abs(slope - given) - DISAGREE_SMOOTH * size[order + 1] - rounding
        worst = np.argsort(off)[::-1][:WORST]
        for k in worst[off[worst] > 0]:
            at = np.linspace(looks[k], looks[k + 1], 2 * PARTS + 1)
            near, pieces = law(at), np.stack([at[:-2:2], at[2::2]], axis=1)
            wrong, slopes, means = _wrong(pieces, near[:-2:2], near[1::2], near[2::2], size, order, CLOSE)
            if wrong.sum() >= PARTS - MOST_RIGHT:
                first = int(np.argmax(wrong))
                raise _error(order, float(pieces[first, 0]), float(slopes[first]), float(means[first]))


def stands_still(looks: np.ndarray, rows: np.ndarray) -> bool:
    """Return True if f is constant at ``looks`` (n,) and its derivatives rounding, as in a dwell."""
    size, long = np.abs(rows).max(axis=0), looks[-1] - looks[0]
    moves = max(size[1] * long, size[2] * long**2)
    return bool(np.ptp(rows[:, 0]) <= ROUNDING * size[0] and moves <= STILL * size[0])


def sizes(looks: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return (3,) the largest f, f' and f'' of ``rows`` (n, 3).

    f'' is at least what a change of f over the whole span takes.
    """
    size = np.abs(rows).max(axis=0)
    size[2] = max(size[2], float(np.ptp(rows[:, 0])) / (looks[-1] - looks[0]) ** 2)
    return size


def check_derivatives(
    at: np.ndarray, left: np.ndarray, middle: np.ndarray, right: np.ndarray, size: np.ndarray
) -> None:
    """Raise DerivativeError if a derivative errs on any piece (n, 2), with rows (n, 3) at three times.

    The three times are those of each piece.
    """
    for order in (0, 1):
        wrong, slope, given = _wrong(at, left, middle, right, size, order, np.inf)
        if wrong.any():
            worst = int(np.argmax(np.where(wrong, np.abs(slope - given), 0.0)))
            raise _error(order, float(at[worst, 0]), float(slope[worst]), float(given[worst]))


def check_rows_of_pieces(
    law: Rows,
    at: np.ndarray,
    left: np.ndarray,
    middle: np.ndarray,
    right: np.ndarray,
    size: np.ndarray,
    most: bool,
) -> None:
    """Raise DerivativeError early, before the fit is complete, for RUN wrong pieces in a row.

    With ``most``, wrong derivatives on more than half of the pieces suffice.

    What repeats within each piece looks wrong at its ends and middle, so parts of a golden section are asked, too.
    """
    for order in (0, 1):
        wrong, _, _ = _wrong(at, left, middle, right, size, order, RESOLVED)
        if _in_a_row(at, wrong) < RUN and not (most and 2 * wrong.sum() > len(wrong)):
            continue
        some = np.flatnonzero(wrong)[:: max(1, int(wrong.sum()) // (4 * RUN))]
        parts = np.stack([at[some, 0], at[some, 0] + GOLDEN * (at[some, 1] - at[some, 0])], axis=1)
        still, slope, given = _wrong(
            parts, left[some], law(parts.mean(axis=1)), law(parts[:, 1]), size, order, RESOLVED
        )
        if 10 * still.sum() >= 9 * len(some):
            worst = int(np.argmax(np.where(still, np.abs(slope - given), 0.0)))
            raise _error(order, float(parts[worst, 0]), float(slope[worst]), float(given[worst]))


def _in_a_row(at: np.ndarray, wrong: np.ndarray) -> int:
    """The most pieces (n, 2) that follow each other and are all wrong."""
    begins = ~wrong
    begins[1:] |= at[1:, 0] != at[:-1, 1]
    return int(np.bincount(np.cumsum(begins)[wrong]).max(initial=0))


def _wrong(
    at: np.ndarray,
    left: np.ndarray,
    middle: np.ndarray,
    right: np.ndarray,
    size: np.ndarray,
    order: int,
    straight: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return True for pieces on which the derivative of f or f' (order 0 or 1) is off, with slopes.

    The slopes (n,) are those of the values, and those that the law gives.
    """
    width = at[:, 1] - at[:, 0]
    slope = (right[:, order] - left[:, order]) / width
    given = (left[:, order + 1] + 4 * middle[:, order + 1] + right[:, order + 1]) / 6  # Simpson's mean
    off = np.abs(slope - given)
    bent = np.abs(left[:, order + 1] - 2 * middle[:, order + 1] + right[:, order + 1])
    resolved = np.isinf(straight) | (bent <= (0.0 if np.isinf(straight) else straight) * off)
    least = DISAGREE if np.isinf(straight) else DISAGREE_SMOOTH
    beside, late = np.maximum(np.abs(left), np.abs(right)), np.abs(at).max(axis=1)
    rounding = ROUNDING * (beside[:, order] + beside[:, order + 1] * late) / width
    return (off > least * size[order + 1] + rounding) & resolved, slope, given


def _error(order: int, time: float, slope: float, given: float) -> DerivativeError:
    of, name = (("f", "df"), ("df", "ddf"))[order]
    return DerivativeError(
        f"function: {name} is not the derivative of {of}: at t = {time:.6g} s {of} rises by {slope:.6g} per second, "
        f"{name} gives {given:.6g}; correct it, or leave df and ddf out"
    )


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
    check_between(law, looks, seen)
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
        check_jump(cut.at, left[k, 0] - right[k - 1, 0], JUMP * float(np.ptp(left[:, 0])))
        check_kink(cut.at, left[k, 1] - right[k - 1, 1], KINK * float(np.abs(left[:, 1]).max()))
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


def _values_at(coefficients: np.ndarray, s: np.ndarray) -> np.ndarray:
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
        met = (np.abs(_values_at(coefficients, width / 2) - real) <= np.maximum(allowed, rounding)).all(axis=1)
        low, high = np.searchsorted(looks, at[:, 0], "right"), np.searchsorted(looks, at[:, 1])
        count = np.maximum(high - low, 0)
        piece = np.repeat(np.arange(len(at)), count)
        which = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count) + np.repeat(low, count)
        off = np.abs(_values_at(coefficients[piece], looks[which] - at[piece, 0])[:, 2] - seen[which])
        noise = np.maximum(allowed, rounding)[piece, 2] + ROUNDING * np.abs(seen[which]) * far / long
        met[piece[off > 4 * noise]] = False
        narrow = width <= max(finest(*span), CLOSEST * long)
        points += [Cut(*at[k, [0, 0, 1]]) for k in np.flatnonzero(~met & narrow)]
        for k in np.flatnonzero(~met & (width < POINT * long)):
            check_jump(float(at[k, 0]), right[k, 0] - left[k, 0], max(JUMP * whole, 10 * peak[1] * width[k]))
            check_kink(float(at[k, 0]), right[k, 1] - left[k, 1], max(KINK * peak[1], 10 * bend[k] * width[k]))
        failing = at[~met], left[~met], real[~met], right[~met]
        check_rows_of_pieces(sampled, *failing, peak, 2 * len(failing[0]) > len(rows) << depth)
        if sampled.count > MOST_TIMES:
            check_derivatives(*failing, peak)
            raise ModelError(
                f"function: the law with its derivatives does not settle near t = {failing[0][0, 0]:.6g} s, after "
                f"{MOST_TIMES} times: it scatters, or a feature of it is too short. Give a shorter span, or breaks="
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
