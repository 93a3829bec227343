"""Starts of many simulations: found for all rows of a chunk at once, and the same in any chunk."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd import ModelError, constant_rate
from mbsd.measures import final
from tests.dynamics.many_models import door, pendulum


def test_starts_do_not_follow_from_which_rows_go_together() -> None:
    rng, count = np.random.default_rng(5), 90
    a, b, omega = rng.uniform(-180, 180, count), rng.uniform(-90, 90, count), rng.uniform(-3, 3, count)
    asked = {"measure": {"x": final("P.x")}, "steps": 5}
    whole = pendulum().simulate_many(0.5, start={"a": a, "b": b}, moving={"b": omega}, threads=1, **asked)
    for threads in (3, 7):
        again = pendulum().simulate_many(0.5, start={"a": a, "b": b}, moving={"b": omega}, threads=threads, **asked)
        assert np.array_equal(whole["x"], again["x"])
    assert whole.alone == [None] * count


@pytest.mark.parametrize("what", ["start", "moving"])
def test_a_body_that_a_driver_places_cannot_be_started(what: str) -> None:
    m = door()
    m.drive_angle("motor", m.bodies["door"], constant_rate(1.0))
    with pytest.raises(ModelError, match="driver 'motor' says where 'door' is"):
        m.simulate_many(1.0, measure={"x": final("door.theta")}, **{what: {"door": [10.0, 20.0]}})
