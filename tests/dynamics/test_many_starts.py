"""Starts of many simulations: found for all rows of a chunk at once, and the same in any chunk."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate
from mbsd.measures import final
from tests.dynamics.many_models import door, pendulum
from tools.models.stops import barrier


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


@pytest.mark.parametrize("model", [door, barrier])
def test_a_start_that_says_nothing_of_its_turn_is_the_reason_of_its_row(model: Callable[[], Mechanism]) -> None:
    """A spring that is turned by so much pulls so hard that its motion would take hours; rows beside it keep theirs."""
    m = model()
    body = list(m.bodies)[1]
    asked = {"measure": {"x": final(f"{body}.theta")}, "steps": 5}
    for far in (1e30, -2e9):
        for first, last in ((0, 1), (1, 0)):
            starts = [20.0, 20.0]
            starts[first] = far
            many = m.simulate_many(0.2, start={body: starts}, **asked)
            assert many.good.tolist() == [bool(first), bool(last)]
            assert f"start of '{body}' is {far:g} degrees" in str(many.reason[first])
            alone = model()
            alone.start_near(**{body: 20.0})
            np.testing.assert_allclose(many["x"][last], alone.simulate(0.2, steps=5).body(body).theta[-1], atol=1e-9)
    with pytest.raises(ModelError, match="1e\\+09 at most, such as what is left of whole turns"):
        m.start_near(**{body: 1e30})
    m.start_near(**{body: 1e9})
