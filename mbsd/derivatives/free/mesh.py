"""Nodes at which tangents of a simulation are found: steps of nine nodes between events, wherever outputs are.

Where a motion bends more, steps are shorter. A polynomial of degree 4 goes through five even times. Its second and
fourth Legendre coefficients tell how fast they fall, and so how large the eighth would be in a longer step.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from mbsd.compiling.jit import kernel
from mbsd.derivatives.free.linear_motion import NODES, PLACES

EVEN = 4
"""Gaps of five even times."""
SAME = 1e-9
"""Part of a step that is none."""
EVENLY = np.linalg.inv(np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, EVEN + 1), EVEN))[[2, EVEN]]
"""(2, 5) what makes Legendre's second and fourth coefficients of values at even times."""
SMOOTH = 1e-4
"""What Legendre's eighth coefficient of the motion itself may be in a step, where these are as many as ``USUAL``."""
USUAL = 50
"""Steps; of more of them each may add less."""
SHORTER, LONGER = 0.1, 2.5
"""So many times as long as usual steps are at least and at most."""
LOOKS = 400
"""Times, at least, at which the motion is looked at."""
CLOSER = 16
"""Times in each step at which a motion is looked at again."""
FAR_OFF = 1e6
"""Error of a step, in shares of it, beyond which four parts would err too much as well: where a toggle is passed."""
ROUNDING = 1e-12
"""Part of the duration below which two times are one."""


@kernel
def fill_lengths(t, motion, per, evenly, smooth, bounds, step, out):
    """Fill out (L - 1,) (s) with lengths of steps between times t (L,) of a motion (L, k), in parts 1 / per (k,).

    evenly (2, 5): what makes both coefficients of five values; smooth: what the eighth may be; bounds (3,): the least,
    the usual and the largest length (s); step (L - 4,) is scratch.
    """
    windows = step.shape[0]
    for w in range(windows):
        second = 0.0
        fourth = 0.0
        for c in range(motion.shape[1]):
            low = 0.0
            high = 0.0
            for n in range(EVEN + 1):
                low += evenly[0, n] * motion[w + n, c]
                high += evenly[1, n] * motion[w + n, c]
            second = max(second, abs(low) * per[c])
            fourth = max(fourth, abs(high) * per[c])
        widest = t[w + 1] - t[w]
        narrowest = widest
        for n in range(1, EVEN):
            gap = t[w + n + 1] - t[w + n]
            widest = max(widest, gap)
            narrowest = min(narrowest, gap)
        if widest - narrowest <= 1e-6 * widest and narrowest > 0.0:
            fall = min(fourth / max(second, 1e-300), 1.0)
            step[w] = (t[w + EVEN] - t[w]) * (smooth / max(fourth * fall * fall, 1e-300)) ** (1.0 / 9.0)
        else:
            step[w] = bounds[1]
    for g in range(out.shape[0]):
        least = bounds[2]
        for n in range(EVEN):
            least = min(least, step[min(max(g - n, 0), windows - 1)])
        out[g] = max(least, bounds[0])


def looked_at(grid: np.ndarray) -> np.ndarray:
    """(L,) times at which the motion is looked at: outputs ``grid`` (T,) and equal parts of the gaps between them."""
    parts = max(3, -(-LOOKS // (len(grid) - 1)))
    inner = grid[:-1, None] + np.diff(grid)[:, None] * (np.arange(parts) / parts)
    return np.append(inner.ravel(), grid[-1])


def looked_at_closer(t: np.ndarray, longest: np.ndarray) -> np.ndarray:
    """(L,) times t (T,) and equal parts of their gaps, ``CLOSER`` in each of the ``longest`` steps (T - 1,) (s)."""
    gaps = np.diff(t)
    parts = np.maximum(1, np.ceil(CLOSER * gaps / longest - SAME)).astype(int)
    at = np.repeat(np.arange(len(gaps)), parts)
    inside = np.arange(len(at)) - np.repeat(np.cumsum(parts) - parts, parts)
    return np.append(t[at] + gaps[at] * (inside / parts[at]), t[-1])


def longest_steps(t: np.ndarray, motion: np.ndarray, per: np.ndarray, usual: float) -> np.ndarray:
    """(L - 1,) how long steps may be between the times t (L,) of a motion (L, k), around the ``usual`` length (s).

    ``per`` (k,) is what makes parts of their largest values of its columns, 0 for one that counts for nothing.
    """
    if len(t) <= EVEN:
        return np.full(len(t) - 1, usual)
    smooth = SMOOTH * min(1.0, USUAL * usual / (t[-1] - t[0]))
    bounds = np.array([SHORTER * usual, usual, LONGER * usual])
    out = np.zeros(len(t) - 1)
    fill_lengths(t, motion, per, EVENLY, smooth, bounds, np.zeros(len(t) - EVEN), out)
    return out


def first_edges(ends: tuple[float, float], met: np.ndarray, t: np.ndarray, longest: np.ndarray) -> np.ndarray:
    """(d + 1,) edges of steps between the ``ends`` and times of events that were ``met`` (s).

    They are as long as ``longest`` (L - 1,) (s) between times t (L,) allows.
    """
    times = np.array(ends)
    if len(met):
        times = np.unique(np.append(met, ends))
        times = times[np.concatenate([[True], np.diff(times) > ROUNDING * (times[-1] - times[0])])]
    passed = np.concatenate([[0.0], np.cumsum(np.diff(t) / longest)])  # steps up to each time
    steps = np.interp(times, t, passed)
    parts = np.maximum(1, np.ceil(np.diff(steps) - SAME)).astype(int)
    edges = [times[:1]]
    for k, count in enumerate(parts):
        edges += [np.interp(np.linspace(steps[k], steps[k + 1], count + 1)[1:-1], passed, t), times[k + 1 : k + 2]]
    return np.concatenate(edges)


def refined(edges: np.ndarray, errors: np.ndarray, enough: float) -> np.ndarray:
    """Edges of shorter steps where these add more than their share of ``enough``, or leave out more inside.

    errors (d, 3): what steps add, what they leave out inside, and what errors of the motion leave unknown.
    """
    shares = np.array([enough / len(errors), enough, enough / math.sqrt(len(errors))])
    out = [edges[:1]]
    for (a, b), worst in zip(pairwise(edges), (errors / shares).max(axis=1), strict=True):
        parts = 1 if worst <= 1.0 else 2 if worst <= 64.0 else 4 if worst <= FAR_OFF else 16
        out.append(np.linspace(a, b, parts + 1)[1:])
    return np.concatenate(out)


def nodes_of(edges: np.ndarray, met: np.ndarray) -> np.ndarray:
    """Times of all nodes (s) but those of events."""
    inner = edges[:-1, None] + np.diff(edges)[:, None] * PLACES[:NODES]
    return apart(np.append(inner.ravel(), edges[-1]), met, float(edges[-1] - edges[0]))


def apart(times: np.ndarray, met: np.ndarray, span: float) -> np.ndarray:
    """Return the times (s) that are no times of events."""
    if not len(met):
        return times
    return times[np.abs(times[:, None] - met[None]).min(axis=1) > ROUNDING * span]
