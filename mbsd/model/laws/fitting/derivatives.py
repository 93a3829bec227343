"""Checks that the derivatives that a law gives are those of f.

Between two times a and b, h = b - a apart,

    (f_b - f_a) / h = (f'_a + f'_b) / 2 - h (f''_b - f''_a) / 12 + h^4 f^(5) / 720

holds between the times of look.py, also on a short stretch; f' is compared with the integral of a spline through f''.
Where it is off, f may change within the stretch unseen, so the worst ones are looked at more closely: a derivative is
wrong that is off in (nearly) every part of one.
Source: the Euler-Maclaurin formula, Abramowitz, Stegun, Handbook of Mathematical Functions, 23.1.30.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.interpolate import CubicSpline

from mbsd.base.errors import ModelError
from mbsd.model.laws.fitting.leaves import ROUNDING
from mbsd.model.laws.fitting.look import GOLDEN

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


def refuse_between(law: Rows, looks: np.ndarray, rows: np.ndarray) -> None:
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


def refuse_derivatives(
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


def refuse_rows_of_pieces(
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
