"""Gas and oil in cylinders in the compiled loop over simulations: what single simulations of the same rows give."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.arrays.packing import pack
from mbsd.base.errors import MechanismError
from mbsd.dynamics.batch.single_run import can_be
from mbsd.measures import final, largest, samples
from tools.models.engines import UP, petrol, slider_crank

STEPS = 40


def engine() -> Mechanism:
    m = slider_crank(petrol(exhaust_opens=math.radians(130.0)), rate=None, start=0.4, fires_at=UP)
    m.start_moving(crank=150.0)
    return m


def air() -> Mechanism:
    """A piston that is thrown against its gas; where it is light enough, it does not reach the head."""
    m = Mechanism("air", gravity=None)
    piston = m.body("piston", 1.0)
    m.prismatic("rail", m.ground.origin, piston.origin)
    m.gas("gas", m.ground.at(-0.1, 0), piston.origin, area=1e-3, pressure=2e5, at=0.1, clearance=0.01)
    m.force("push", piston.origin, -1.0, 0.0)
    m.start_moving(piston=(-3.0, 0, 0))
    return m


def ram() -> Mechanism:
    """A ram that lifts an arm, first one way and then the other."""
    m = Mechanism("ram")
    arm = m.bar("arm", 1.5, mass=40.0)
    m.revolute("pin", m.ground.origin, arm.start)
    m.hydraulic_cylinder(
        "ram", m.ground.at(0.2, -0.6), arm.at(0.7, 0.0), 0.05, 0.03, 0.5, 0.55, 1.6e7, rated_flow=4e-4,
        valve=lambda t: 0.4 * math.sin(4.0 * t), air=0.005,
    )  # fmt: skip
    m.start_near(arm=0)
    return m


Build = Callable[[], Mechanism]
CASES: dict[str, tuple[Build, float, dict[str, tuple[str, float, float]], str]] = {
    "engine": (engine, 0.1, {"crank": ("mass", 1.0, 3.0)}, "crank"),
    "air": (air, 0.3, {"piston": ("mass", 0.5, 2.0)}, "piston"),
    "pressed": (air, 0.3, {"gas": ("pressure", 1e5, 3e5)}, "piston"),
    "ram": (ram, 0.5, {"arm": ("mass", 20.0, 60.0)}, "arm"),
}


@pytest.mark.parametrize("case", CASES)
def test_cylinders_have_the_digits_of_single_simulations(case: str) -> None:
    build, duration, varied, body = CASES[case]
    random, count = np.random.default_rng(11), 8
    vary = {name: {key: random.uniform(low, high, count)} for name, (key, low, high) in varied.items()}
    measures: dict[str, Any] = {
        "x": samples(f"{body}.x", [0.5 * duration, duration]),
        "omega": final(f"{body}.omega"),
        "v": final(f"{body}.vx"),
        "a": largest(f"{body}.ax"),
        "work": final("work"),
    }
    many = build().simulate_many(duration, vary=vary, measure=measures, steps=STEPS)
    assert many.alone == [None] * count, many.way
    for k in range(count):
        m = build()
        for name, values in vary.items():
            m.change(name, **{key: float(column[k]) for key, column in values.items()})
        sol = m.simulate(duration, steps=STEPS)
        own = sol.body(body)
        assert sol.work is not None
        assert np.array_equal(many["x"][k], own.x[[STEPS // 2, STEPS]])
        assert many["omega"][k] == own.omega[-1]
        assert many["v"][k] == own.vx[-1]
        np.testing.assert_allclose(many["a"][k], own.ax.max(), rtol=1e-9)
        np.testing.assert_allclose(many["work"][k], sol.work[-1], rtol=1e-12)


def test_a_piston_without_room_is_a_reason() -> None:
    start = {"piston": [(-0.2, 0.0, 0.0), (0.0, 0.0, 0.0)]}
    many = air().simulate_many(0.1, start=start, measure={"x": final("piston.x")}, steps=STEPS)
    assert many.good.tolist() == [False, True]
    m = air()
    m.start_near(piston=(-0.2, 0, 0))
    with pytest.raises(MechanismError) as single:
        m.simulate(0.1, steps=STEPS)
    assert str(single.value) in str(many.reason[0])


def test_room_is_looked_at_along_a_motion() -> None:
    packed, t = pack(air()), np.array([0.0, 0.1])
    y = np.zeros((2, 2, 6))
    assert can_be(packed, t, y)
    y[1, 0, 3] = -0.2
    assert not can_be(packed, t, y)
    assert can_be(packed, t[:1], y[:1])
