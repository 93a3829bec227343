"""A solution as arrays of its states, and some of its rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mbsd.derivatives.numbers.terms import Along
from mbsd.results.solution import Solution


def along_of(sol: Solution) -> Along:
    """A solution as arrays."""
    q, v, a = (np.ascontiguousarray(part.reshape(len(sol.t), -1)) for part in (sol.q, sol.v, sol.a))
    return Along(sol.t if sol.law_times is None else sol.law_times, q, v, a, sol.lam, sol.states, sol.approached)


def rows_of(sol: Solution, rows: np.ndarray) -> Solution:
    """Some rows of a solution."""
    keys = ("t", "q", "v", "a", "wrench", "lam", "drives", "work", "held", "law_times", "approached", "states")
    parts = {key: getattr(sol, key)[rows] for key in keys if getattr(sol, key) is not None}
    margin = sol.margin if callable(sol.margin) else sol.margin[rows]
    return replace(sol, margin=margin, between=None, **parts)
