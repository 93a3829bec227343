"""Events that release joints in the compiled loop over simulations: what single simulations of the same rows give."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, angle_reaches
from mbsd.measures import final, largest, samples
from tests.dynamics.beside_single_runs import assert_as_single_ones, between
from tools.models.releases import chain, sling

STEPS = 40


CASES: dict[str, tuple[Callable[[], Mechanism], dict[str, tuple[str, float, float]], str]] = {
    "sling": (sling, {"spring": ("torque", 3.0, 5.0)}, "hinge.fy"),
    "chain": (chain, {"spring": ("stiffness", 0.0, 4.0)}, "motor.effort"),
}


@pytest.mark.parametrize("case", CASES)
def test_joints_are_released_as_in_single_simulations(case: str) -> None:
    build, varied, own = CASES[case]
    random, count = np.random.default_rng(2), 8
    vary = {name: {key: random.uniform(low, high, count)} for name, (key, low, high) in varied.items()}
    times = np.linspace(0.0, 1.2, STEPS + 1).tolist()
    measure: dict[str, Any] = {
        "x": samples("arm.x", times), "theta": samples("arm.theta", times), "own": samples(own, times),
        "hinge": samples("hinge.fx", times), "most": largest("arm.omega"), "work": final("work"),
    }  # fmt: skip
    many = build().simulate_many(1.2, vary=vary, measure=measure, steps=STEPS)
    assert many.alone == [None] * count, many.way
    met = 0
    for k in range(count):
        m = build()
        for name, values in vary.items():
            m.change(name, **{key: float(column[k]) for key, column in values.items()})
        sol = m.simulate(1.2, steps=STEPS)
        met += sum(event.what == "event" for event in sol.events)
        columns = dict(zip([c.rpartition(" [")[0] for c in sol.columns()], sol.columns().values(), strict=True))
        np.testing.assert_allclose(many["x"][k], sol.body("arm").x, atol=1e-9)
        np.testing.assert_allclose(many["theta"][k], sol.body("arm").theta, atol=1e-9)
        np.testing.assert_allclose(many["own"][k], columns[own], atol=1e-6)
        np.testing.assert_allclose(many["hinge"][k], columns["hinge.fx"], atol=1e-6)
        np.testing.assert_allclose(many["most"][k], sol.body("arm").omega.max(), atol=1e-8)
        assert columns["hinge.fx"][-1] == 0.0 == many["hinge"][k, -1]
    assert met >= count


def test_a_row_begins_with_all_its_joints() -> None:
    many = sling().simulate_many(
        1.2, vary={"spring": {"torque": [4.0, 4.0, 0.0, 4.0]}}, measure={"y": final("arm.y")}, steps=STEPS, threads=1
    )
    assert many["y"][0] == many["y"][1] == many["y"][3]
    assert many["y"][2] == pytest.approx(1.0, abs=1e-12)


def test_a_body_without_mass_that_is_let_go_goes_on_as_it_went() -> None:
    m = Mechanism("light")
    rod, bob = m.bar("rod", 0.5, mass=0.0), m.body("arm", mass=1.0, inertia=0.1)
    m.revolute("A", m.ground.origin, rod.start)
    m.weld("B", rod.end, bob.origin)
    m.torque("drive", bob, 0.0)
    m.event("low", angle_reaches(rod, -1.0), releases="B")
    m.start_near(rod=0)
    many = m.simulate_many(2.0, vary={"drive": {"torque": [0.0, 80.0]}}, measure={"t": final("rod.theta")}, steps=5)
    assert many.alone == [None, None], many.way
    sol = m.simulate(2.0, steps=5)
    np.testing.assert_allclose(sol.body("rod").omega[-1], sol.body("rod").omega[-2], rtol=1e-9)
    np.testing.assert_allclose(many["t"][0], sol.body("rod").theta[-1], atol=1e-9)


def test_what_can_not_be_released_is_refused() -> None:
    m = sling()
    value = angle_reaches(m.bodies["arm"], 1.0)
    with pytest.raises(ModelError, match=r"event 'a': .*joint to release 'hing'.*hinge"):
        m.event("a", value, releases="hing")
    with pytest.raises(ModelError, match="releases is 3"):
        m.event("a", value, releases=3)  # pyright: ignore[reportArgumentType]
    with pytest.raises(ModelError, match="ends the simulation"):
        m.event("a", value, releases="hinge", terminal=True)
    assert "a" not in m.events


@pytest.mark.slow
@settings(max_examples=12, suppress_health_check=[HealthCheck.too_slow], deadline=None)
@given(st.data())
def test_random_chains_break_as_by_themselves(data: st.DataObject) -> None:
    m = Mechanism("chain")
    end = m.ground.at(0, 0)
    count, places = data.draw(st.integers(2, 4)), {}
    for k in range(count):
        bar = m.bar(f"bar{k}", data.draw(between(0.2, 0.6)), mass=data.draw(between(0.2, 2.0)))
        m.revolute(f"pin{k}", end, bar.start)
        m.friction(f"rub{k}", f"pin{k}", data.draw(between(0.0, 0.2)), radius=0.02)
        places[f"bar{k}"] = data.draw(between(-60.0, 30.0))
        turned = math.radians(places[f"bar{k}"]) - data.draw(between(0.1, 2.0))
        m.event(f"breaks{k}", angle_reaches(bar, turned), releases=f"pin{k}")
        end = bar.end
    floor = data.draw(between(-1.5, -0.3))
    m.rigid_contact("floor", m.ground.at(0, floor - 1.0), end, radius=0.02, restitution=0.4, friction=0.2)
    m.start_near(**places)
    assert_as_single_ones(m, f"bar{count - 1}", 0.8, 8, 1e-9)


@pytest.mark.parametrize("duration", [1e-9, 1e-6, 1e-3, 0.3])
def test_a_bar_that_starts_where_it_breaks_and_leaves_breaks_when_it_comes_back(duration: float) -> None:
    m = Mechanism("bars")
    end = m.ground.at(0, 0)
    for k in range(2):
        bar = m.bar(f"bar{k}", 0.2, mass=0.5 / (k + 1))
        m.revolute(f"pin{k}", end, bar.start)
        m.event(f"breaks{k}", angle_reaches(bar, 0.0), releases=f"pin{k}")
        end = bar.end
    m.start_near(bar0=0, bar1=0)
    alone = m.simulate(duration, steps=4)
    assert not [event for event in alone.events if event.time < 1e-3]
    many = m.simulate_many(duration, vary={"bar0": {"mass": [0.5, 0.4]}}, measure={"x": final("bar1.x")}, steps=4)
    assert many.good.all()
    assert many["x"][0] == pytest.approx(alone.body("bar1").x[-1], rel=1e-12)
