"""A law whose derivatives are given, as quintic pieces through f, f', f'' at their ends.

A piece is met where it agrees with the law in its middle, where its error is largest, and with f'' at the times that
are looked at beside (look.py); else it is halved. Pieces that shrink onto a point tell where f'' jumps: the span is cut
there, as rounding spoils f'' of narrow pieces. Where f at both ends agrees with f' and f'' but for rounding, their
quartic is taken, so that f'' does not show the rounding of f.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.model.laws.fitting.cuts import Cut, finest, given_cuts, merged, roots, without_edges
from mbsd.model.laws.fitting.leaves import FAINT, JUMP, KINK, POINT, ROUNDING, USUAL, refuse_jump, refuse_kink
from mbsd.model.laws.fitting.sampled import Sampled
from mbsd.model.laws.numbers import Compiled, pieces, quintic_coefficients

TOLERANCE = np.array([1e-12, 1e-10, 1e-9])
"""Of f, f' and f'' of their size."""
MOST_TIMES = 600_000
CLOSEST = 1e-12
"""Part of the span within which a jump of f'' is found."""
DISAGREE = 1e-3
"""Part of f' by which df may differ from the slope of f, and ddf from that of df, where nothing else is known."""
DISAGREE_SMOOTH = 1e-6
"""The same on pieces on which the derivative is so straight (RESOLVED) that its mean is known."""
RESOLVED = 1e-2
"""Part of such a difference below which a derivative must be bent for it to count before all else is tried."""
ROUNDS = 4
EPSILON = float(np.finfo(float).eps)


class DerivativeError(ModelError):
    """A derivative that its author gave is not that of f."""


Rows = Callable[[np.ndarray], np.ndarray]


def exact_pieces(
    law: Rows, first: float, last: float, breaks: Sequence[float], looks: np.ndarray, seen: np.ndarray
) -> Compiled:
    """``law`` gives (n, 3) at times (n,); ``seen`` (n,): f'' at the times ``looks``.

    Raises ModelError where f or f' jumps, and where the derivatives are not those of f.
    """
    sampled = Sampled(law)
    found = given_cuts(breaks, first, last)
    for _ in range(ROUNDS):
        cuts, begin, end = without_edges(found, first, last)
        rows, new = _refined(sampled, (first, last), begin, end, cuts, looks, seen)
        edges = [begin, end, *(edge for cut in cuts for edge in (cut.left, cut.right))]
        new = [cut for cut in new if not any(cut.left <= edge <= cut.right for edge in edges)]
        if not new:
            break
        found = merged([*found, *new], 4 * finest(first, last))
    at, left, right = rows
    for cut in cuts:
        k = int(np.searchsorted(at[:, 0], cut.at))
        refuse_jump(cut.at, left[k, 0] - right[k - 1, 0], JUMP * float(np.ptp(left[:, 0])))
        refuse_kink(cut.at, left[k, 1] - right[k - 1, 1], KINK * float(np.abs(left[:, 1]).max()))
    coefficients = _quintics(at[:, 1] - at[:, 0], left, right, max(abs(first), abs(last)))
    return pieces(np.append(at[:, 0], at[-1, 1]), coefficients)


def _quintics(h: np.ndarray, left: np.ndarray, right: np.ndarray, far: float) -> np.ndarray:
    """(n, 6) of widths h (n,), from f, f', f'' (n, 3) at both ends; ``far`` (s): largest time."""
    slope, bend = (right[:, 1] - left[:, 1] - h * left[:, 2]) * h, (right[:, 2] - left[:, 2]) * h**2
    rise = right[:, 0] - left[:, 0] - h * left[:, 1] - h**2 * left[:, 2] / 2
    beside = np.maximum(np.abs(left), np.abs(right))
    by_rates = slope / 2 - bend / 12
    rounded = np.abs(rise - by_rates) <= EPSILON * (beside[:, 0] + beside[:, 1] * far)
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
        coefficients = _quintics(width, left, right, far)
        bend = np.maximum.reduce([np.abs(left[:, 2]), np.abs(right[:, 2]), np.abs(real[:, 2]), above])
        scale = np.stack([np.full(len(at), size[0]), np.full(len(at), size[1]), np.maximum(bend, usual)], axis=1)
        value, slope = np.abs(real[:, 0]) + size[1] * far, np.abs(real[:, 1]) + np.maximum(bend, usual) * far
        rounding = ROUNDING * np.stack([value, slope, np.abs(real[:, 2]) + slope / width], axis=1)
        allowed = TOLERANCE * scale
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
            refuse_jump(float(at[k, 0]), right[k, 0] - left[k, 0], max(JUMP * range_, 10 * size[1] * width[k]))
            refuse_kink(float(at[k, 0]), right[k, 1] - left[k, 1], max(KINK * size[1], 10 * bend[k] * width[k]))
        failing = at[~met], left[~met], real[~met], right[~met]
        if 2 * len(failing[0]) > len(rows) << depth:
            _refuse_derivatives(*failing, size, RESOLVED)
        if sampled.count > MOST_TIMES:
            _refuse_derivatives(*failing, size)
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


def _refuse_derivatives(
    at: np.ndarray,
    left: np.ndarray,
    middle: np.ndarray,
    right: np.ndarray,
    size: np.ndarray,
    straight: float = np.inf,
) -> None:
    """Raise DerivativeError where a derivative is not that of f; only where it is straight to this part of it."""
    width = at[:, 1] - at[:, 0]
    for order, (of, name) in enumerate((("f", "df"), ("df", "ddf"))):
        slope = (right[:, order] - left[:, order]) / width
        given = (left[:, order + 1] + 4 * middle[:, order + 1] + right[:, order + 1]) / 6  # Simpson's mean
        off = np.abs(slope - given)
        bent = np.abs(left[:, order + 1] - 2 * middle[:, order + 1] + right[:, order + 1])
        least = DISAGREE if np.isinf(straight) else DISAGREE_SMOOTH
        wrong = (off > least * size[order + 1]) & (bent <= straight * off)
        if 2 * wrong.sum() > len(wrong) or (np.isinf(straight) and wrong.any()):
            worst = int(np.argmax(np.where(wrong, off, 0.0)))
            raise DerivativeError(
                f"function: {name} is not the derivative of {of}: at t = {at[worst, 0]:.6g} s {of} rises by "
                f"{slope[worst]:.6g} per second, {name} gives {given[worst]:.6g}; correct it, or leave df and ddf out"
            )
