"""Starts of many simulations: found for all rows of a chunk at once, and the same in any chunk."""

from __future__ import annotations

import numpy as np

from mbsd.measures import final
from tests.dynamics.test_many import pendulum


def test_starts_do_not_follow_from_which_rows_go_together() -> None:
    rng, count = np.random.default_rng(5), 90
    a, b, omega = rng.uniform(-180, 180, count), rng.uniform(-90, 90, count), rng.uniform(-3, 3, count)
    asked = {"measure": {"x": final("P.x")}, "steps": 5}
    whole = pendulum().simulate_many(0.5, start={"a": a, "b": b}, moving={"b": omega}, threads=1, **asked)
    for threads in (3, 7):
        again = pendulum().simulate_many(0.5, start={"a": a, "b": b}, moving={"b": omega}, threads=threads, **asked)
        assert np.array_equal(whole["x"], again["x"])
    assert whole.alone == [None] * count
