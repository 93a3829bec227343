"""Nodes at which tangents of a simulation are found: steps of five nodes between outputs and events."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from mbsd.derivatives.linear_motion import NODES, PLACES

SAME = 1e-9
"""Part of their length within which two gaps between outputs are equal."""
EVENLY = np.linalg.inv(np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, NODES + 1), NODES))[[2, NODES]]
"""(2, 5) what makes Legendre's second and fourth coefficients of values at even times."""
SMOOTH = 1.5e-8
"""What Legendre's eighth coefficient of the motion itself may be in a step, where these are as many as ``USUAL``."""
USUAL = 90
"""Steps; of more of them each may add less."""
SHORTER, LONGER = 0.25, 2.5
"""So many times as long as usual steps are at least and at most."""
LOOKS = 400
"""Times, at least, at which the motion is looked at."""
ROUNDING = 1e-12
"""Part of the duration below which two times are one."""


def looked_at(grid: np.ndarray) -> np.ndarray:
    """(L,) times at which the motion is looked at: outputs ``grid`` (T,) and equal parts of the gaps between them."""
    parts = max(3, -(-LOOKS // (len(grid) - 1)))
    inner = grid[:-1, None] + np.diff(grid)[:, None] * (np.arange(parts) / parts)
    return np.append(inner.ravel(), grid[-1])


def longest_steps(t: np.ndarray, motion: np.ndarray, usual: float) -> np.ndarray:
    """(L - 1,) how long steps may be between the times t (L,) of a motion (L, k), around the ``usual`` length (s).

    ``motion`` has parts of its largest values. Five times with equal gaps tell how fast Legendre's coefficients fall.
    """
    gaps, windows = np.diff(t), len(t) - NODES
    if windows < 1:
        return np.full(len(gaps), usual)
    second, fourth = (
        np.abs(sum(weight * motion[n : n + windows] for n, weight in enumerate(row))).max(axis=1) for row in EVENLY
    )
    fall = np.minimum(fourth / np.maximum(second, 1e-300), 1.0)
    smooth = SMOOTH * min(1.0, USUAL * usual / (t[-1] - t[0]))
    step = (t[NODES:] - t[:windows]) * (smooth / np.maximum(fourth * fall**2, 1e-300)) ** (1 / 9)
    around = [gaps[n : n + windows] for n in range(NODES)]
    widest, narrowest = np.max(around, axis=0), np.min(around, axis=0)
    even = (widest - narrowest <= 1e-6 * widest) & (narrowest > 0.0)
    known = np.pad(np.where(even, step, usual), NODES - 1, mode="edge")
    least = np.min([known[k : k + len(gaps)] for k in range(NODES)], axis=0)
    return np.clip(least, SHORTER * usual, LONGER * usual)


def first_edges(grid: np.ndarray, met: np.ndarray, t: np.ndarray, longest: np.ndarray) -> np.ndarray:
    """(d + 1,) edges of steps from outputs ``grid`` and times of events that were ``met`` (s).

    They are as long as ``longest`` (L - 1,) (s) between times t (L,) allows. Two equal gaps of outputs may make one
    step, whose middle is an output.
    """
    times = np.unique(np.concatenate([grid, met]))
    times = times[np.concatenate([[True], np.diff(times) > ROUNDING * (times[-1] - times[0])])]
    passed = np.concatenate([[0.0], np.cumsum(np.diff(t) / longest)])  # steps up to each time
    steps = np.interp(times, t, passed)
    gaps, parts = np.diff(times), np.maximum(1, np.ceil(np.diff(steps) - SAME)).astype(int)
    pair = (np.abs(np.diff(gaps)) <= SAME * gaps[:-1]) & (steps[2:] - steps[:-2] <= 1.0)
    if len(met):
        pair &= ~np.isin(times[1:-1], met)
    edges, k = [float(times[0])], 0
    while k < len(gaps):
        if k < len(pair) and pair[k]:
            k += 1
        elif parts[k] > 1:
            inner = np.linspace(steps[k], steps[k + 1], parts[k] + 1)[1:-1]
            edges += np.interp(inner, passed, t).tolist()
        edges.append(float(times[k + 1]))
        k += 1
    return np.array(edges)


def refined(edges: np.ndarray, errors: np.ndarray, enough: float) -> np.ndarray:
    """Edges of shorter steps where these add more than their share of ``enough``."""
    share = enough / len(errors)
    out = [edges[:1]]
    for (a, b), error in zip(pairwise(edges), errors, strict=True):
        parts = 1 if error <= share else 4 if error > 64 * share else 2
        out.append(np.linspace(a, b, parts + 1)[1:])
    return np.concatenate(out)


def nodes_of(edges: np.ndarray, grid: np.ndarray, met: np.ndarray) -> np.ndarray:
    """Times of all nodes (s) but those of events; outputs to the bit."""
    inner = edges[:-1, None] + np.diff(edges)[:, None] * PLACES[:NODES]
    nodes = np.append(inner.ravel(), edges[-1])
    slack = 10 * SAME * float(np.diff(edges).min())
    at = np.clip(np.searchsorted(nodes, grid), 1, len(nodes) - 1)
    at -= (grid - nodes[at - 1]) < (nodes[at] - grid)
    near = np.abs(nodes[at] - grid) <= slack
    nodes[at[near]] = grid[near]
    if len(met):
        far = np.abs(nodes[:, None] - met[None]).min(axis=1) > ROUNDING * (edges[-1] - edges[0])
        nodes = nodes[far]
    return np.unique(nodes)
