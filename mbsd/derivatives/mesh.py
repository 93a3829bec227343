"""Nodes at which tangents of a simulation are found: steps of five nodes between outputs and events."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from mbsd.derivatives.linear_motion import NODES, PLACES

SAME = 1e-9
"""Part of their length within which two gaps between outputs are equal."""
ROUNDING = 1e-12
"""Part of the duration below which two times are one."""


def first_edges(grid: np.ndarray, met: np.ndarray, longest: float) -> np.ndarray:
    """(d + 1,) edges of steps from outputs ``grid`` and times of events that were ``met`` (s).

    None is longer than ``longest`` (s). Two equal gaps of outputs make one step, whose middle is an output.
    """
    times = np.unique(np.concatenate([grid, met]))
    times = times[np.concatenate([[True], np.diff(times) > ROUNDING * (times[-1] - times[0])])]
    events = set(met.tolist())
    edges, k = [float(times[0])], 0
    while k + 1 < len(times):
        gap = times[k + 1] - times[k]
        pair = k + 2 < len(times) and abs(times[k + 2] - times[k + 1] - gap) <= SAME * gap
        if pair and 2 * gap <= longest and not any(abs(times[k + 1] - event) < SAME * gap for event in events):
            k += 2
            edges.append(float(times[k]))
            continue
        parts = max(1, int(np.ceil(gap / longest - SAME)))
        edges += np.linspace(times[k], times[k + 1], parts + 1)[1:].tolist()
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
