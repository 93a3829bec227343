"""Linear complementarity by Lemke's method, as contacts ask it."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd.dynamics.events.laws.lcp import lemke


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
