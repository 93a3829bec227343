"""Points on curves that cross themselves in the compiled loop over simulations: what single simulations give."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.measures import final, largest, samples
from tools.models.guided import EIGHT, coaster

STEPS = 30
CASES: dict[str, Callable[[], Mechanism]] = {
    "track": coaster,
    "events": lambda: coaster(events=True),
    "stop": lambda: coaster(stop=True),
}


@pytest.mark.filterwarnings("ignore::mbsd.base.errors.InitialConditionWarning")
@pytest.mark.parametrize("case", CASES)
def test_points_go_on_along_their_branch_as_in_single_simulations(case: str) -> None:
    build, duration, count = CASES[case], 2.0, 8
    random = np.random.default_rng(4)
    vary: dict[str, Any] = {"tie": {"stiffness": random.uniform(20.0, 120.0, count)}}
    measures = {"x": samples("bead.x", [1.0, 2.0]), "y": final("bead.y"), "v": largest("bead.vx")}
    tolerance = 1e-8 if case == "track" else 1e-11  # trial steps to an event decide how the steps to it are divided
    many = build().simulate_many(duration, vary=vary, measure=measures, steps=STEPS, tolerance=tolerance)
    assert many.alone == [None] * count, many.way
    crossed = met = 0
    for k in range(count):
        m = build()
        m.change("tie", stiffness=float(vary["tie"]["stiffness"][k]))
        sol = m.simulate(duration, steps=STEPS, tolerance=tolerance)
        bead = sol.body("bead")
        crossed += int((np.diff(np.sign(bead.x)) != 0).sum())
        met += len(sol.events)
        np.testing.assert_allclose(many["x"][k], bead.x[[STEPS // 2, STEPS]], atol=1e-8)
        np.testing.assert_allclose(many["y"][k], bead.y[-1], atol=1e-8)
        np.testing.assert_allclose(many["v"][k], bead.vx.max(), atol=1e-7)
        if case == "track":
            assert np.array_equal(many["x"][k], bead.x[[STEPS // 2, STEPS]])
    assert crossed >= count
    assert (case == "track") == (met == 0)


def test_starts_on_other_branches_and_reactions() -> None:
    starts = [(*EIGHT[10], 0.0), (*EIGHT[40], 0.0)]
    many = coaster().simulate_many(1.0, start={"bead": starts}, measure={"x": final("bead.x")}, steps=STEPS)
    assert many.alone == [None, None], many.way
    for k, start in enumerate(starts):
        m = coaster()
        m.start_near(bead=start)
        np.testing.assert_allclose(many["x"][k], m.simulate(1.0, steps=STEPS).body("bead").x[-1], atol=1e-9)
    vary = {"tie": {"stiffness": [20.0, 40.0]}}
    many = coaster().simulate_many(0.2, vary=vary, measure={"f": final("track.fx")}, steps=4)
    assert many.way == "2 one by one (reactions where points are on curves that cross themselves)"
