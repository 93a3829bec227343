"""Linear complementarity by Lemke's method, as contacts ask it."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd.compiling.jit import kernel
from mbsd.dynamics.events.pushes import lowest_row, pivot_to_end


@kernel
def pivoted(tableau, basis, n):
    """Pivot a tableau to the end; False where that has none."""
    row = lowest_row(tableau, n)
    return row < 0 or pivot_to_end(tableau, basis, n, row)


def lemke(matrix: np.ndarray, q: np.ndarray) -> np.ndarray | None:
    """Return z (n,) for M (n, n) and q (n,); None where there is none."""
    n = len(q)
    tableau = np.hstack([np.eye(n), -matrix, -np.ones((n, 1)), q[:, None]])
    basis, z = np.arange(n), np.zeros(2 * n + 1)
    if not pivoted(tableau, basis, n):
        return None
    z[basis] = tableau[:, -1]
    return z[n : 2 * n]


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 8), st.integers(1, 8), st.integers(0, 2**32 - 1))
def test_lemke_solves_what_contacts_ask(contacts: int, freedoms: int, seed: int) -> None:
    """G = A A^T, singular where contacts outnumber freedoms; g = A u, as gaps of real motions."""
    rng = np.random.default_rng(seed)
    a = rng.normal(size=(contacts, freedoms))
    g = a @ a.T
    size = np.diag(g).max()
    q = a @ rng.normal(size=freedoms)
    z = lemke(g / size, q)
    assert z is not None
    w = g / size @ z + q
    assert z.min() >= 0.0
    assert w.min() > -1e-8
    assert abs(z @ w) < 1e-7 * max(1.0, np.abs(z).max())
