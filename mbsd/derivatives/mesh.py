"""Nodes at which tangents of a simulation are found: steps of five nodes between outputs and events."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from mbsd.derivatives.linear_motion import NODES, PLACES

SAME = 1e-9
"""Part of their length within which two gaps between outputs are equal."""
EVENLY = np.linalg.inv(np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, NODES + 1), NODES))[[2, NODES]]
"""(2, 5) what makes Legendre's second and fourth coefficients of values at even times."""
SMOOTH = 2.5e-8
"""What Legendre's eighth coefficient of the motion itself may be in a step."""
MOST_LONGER = 2.5
"""So many times as long as where it is not smooth."""
ROUNDING = 1e-12
"""Part of the duration below which two times are one."""


def longest_steps(t: np.ndarray, motion: np.ndarray, longest: float) -> np.ndarray:
    """(T - 1,) how long steps may be between the times of a motion (T, k): ``longest`` (s), more where it is smooth.

    ``motion`` has parts of its largest values. Five times with equal gaps tell how fast Legendre's coefficients fall.
    """
    gaps, windows = np.diff(t), len(t) - NODES
    out = np.full(len(gaps), longest)
    if windows < 1:
        return out
    at = np.arange(windows)[:, None] + np.arange(NODES + 1)
    second, fourth = (np.abs(np.einsum("n,wnk->wk", row, motion[at])).max(axis=1) for row in EVENLY)
    fall = np.minimum(fourth / np.maximum(second, 1e-300), 1.0)
    step = (t[NODES:] - t[:windows]) * (SMOOTH / np.maximum(fourth * fall**2, 1e-300)) ** (1 / 9)
    around = gaps[at[:, :NODES]]
    even = (np.ptp(around, axis=1) <= 1e-6 * around.max(axis=1)) & (around.min(axis=1) > 0.0)
    smooth = np.pad(np.where(even, step, 0.0), NODES - 1, mode="edge")
    least = np.min([smooth[k : k + len(gaps)] for k in range(NODES)], axis=0)
    return np.clip(least, longest, MOST_LONGER * longest)


def first_edges(grid: np.ndarray, met: np.ndarray, t: np.ndarray, longest: np.ndarray) -> np.ndarray:
    """(d + 1,) edges of steps from outputs ``grid`` and times of events that were ``met`` (s).

    None is longer than ``longest`` (T - 1,) (s) between times t (T,). Two equal gaps of outputs make one step, whose
    middle is an output.
    """
    times = np.unique(np.concatenate([grid, met]))
    times = times[np.concatenate([[True], np.diff(times) > ROUNDING * (times[-1] - times[0])])]
    gaps, middles = np.diff(times), 0.5 * (times[1:] + times[:-1])
    allowed = longest[np.clip(np.searchsorted(t, middles) - 1, 0, len(longest) - 1)]
    parts = np.maximum(1, np.ceil(gaps / allowed - SAME)).astype(int)
    event = np.isin(times[1:-1], met)
    pair = (
        (np.abs(np.diff(gaps)) <= SAME * gaps[:-1]) & (2 * gaps[:-1] <= np.minimum(allowed[:-1], allowed[1:])) & ~event
    )
    edges, k = [float(times[0])], 0
    while k < len(gaps):
        if k < len(pair) and pair[k]:
            k += 1
            edges.append(float(times[k + 1]))
        elif parts[k] == 1:
            edges.append(float(times[k + 1]))
        else:
            edges += np.linspace(times[k], times[k + 1], parts[k] + 1)[1:].tolist()
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
