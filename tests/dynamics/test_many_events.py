"""Events, contacts and cylinders in many simulations: reasons of rows that fail, and what is kept between rows."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
import pytest

from mbsd import Mechanism, ModelError, SimulationError, angle_reaches, distance_reaches
from mbsd.arrays.packing import pack
from mbsd.base.errors import MechanismError
from mbsd.dynamics.batch import worker
from mbsd.dynamics.batch.single_run import Base, single_run
from mbsd.dynamics.events import packing as made
from mbsd.dynamics.simulate import request_for
from mbsd.measures import final, first, largest, smallest
from tests.dynamics.many_models import air
from tools.models.guided import free_geneva, loose_gears
from tools.models.releases import cranks, sling
from tools.models.rough_contacts import ball as rough_ball
from tools.models.rough_contacts import belt, rod
from tools.models.stops import ball, barrier, bumpers
from tools.models.user_events import halved, height, swing

STEPS = 20
EXACT = 2e-9


def test_what_is_not_compiled_falls_back_and_is_named() -> None:
    cases: dict[str, Callable[[Mechanism, Any], object]] = {
        "gets a moment": lambda m, arm: m.event("late", lambda t, moment: t - 0.3),
        "function is one of Python": lambda m, arm: m.event("late", lambda t, q, v: t - 0.3, frames=arm),
        "action is one of Python": lambda m, arm: m.event("late", height, frames=arm, action=lambda t, q, v: v),
    }
    for why, add in cases.items():
        m = swing()
        add(m, m.bodies["arm"])
        many = m.simulate_many(0.5, start={"arm": [-80.0, -60.0]}, measure={"a": final("arm.theta")}, steps=STEPS)
        assert "2 one by one (event 'late'" in many.way
        assert why in many.way
        m.start_near(arm=-60)
        assert many["a"][1] == m.simulate(0.5, steps=STEPS).body("arm").theta[-1]


def test_a_function_that_fails_is_a_reason() -> None:
    m = swing()
    bad = numba.njit(lambda t, q, v: math.nan if q[1] < -0.495 else 1.0)
    m.event("bad", bad, frames=m.bodies["arm"].end)
    many = m.simulate_many(0.2, start={"arm": [-100.0, -30.0]}, measure={"a": final("arm.theta")}, steps=STEPS)
    assert many.good.tolist() == [False, True]
    assert "event 'bad': its function: at t = 0.09" in str(many.reason[0])


def test_the_interface_of_frames() -> None:
    m = swing()
    arm = m.bodies["arm"]
    with pytest.raises(ModelError, match=r"cannot take a Moment.*frames="):
        m.event("a", height)
    with pytest.raises(ModelError, match="frames are 3"):
        m.event("a", height, frames=3)  # pyright: ignore[reportArgumentType]
    with pytest.raises(ModelError, match="another mechanism"):
        m.event("a", height, frames=swing().bodies["arm"])
    with pytest.raises(ModelError, match="each moving body once"):
        m.event("a", height, frames=(arm, arm.end), action=halved)
    m.event("three", lambda t, q, v: q[0] - 0.1, frames=arm.end, action=lambda t, q, v: (1.0, 2.0))
    with pytest.raises(ModelError, match=r"its action fails.*gives 2 numbers; 3 are wanted"):
        m.simulate(1.0)


def test_markers_at_the_end_of_a_bar_move_with_it() -> None:
    m = swing()
    m.event("near", distance_reaches(m.ground.at(0.4, 0.0), m.bodies["arm"].end, 0.05))
    m.change("arm", length=0.4)
    frames = [frame for event in m.events.values() for frame in event.frames]
    assert [frame.x for frame in frames] == [0.4, 0.4]
    assert min(event.time for event in m.simulate(1.5).events if event.name == "near") > 0.0


def test_starts_vary_and_rows_end_early_by_the_steps_of_whole_ones() -> None:
    degrees = np.linspace(-170.0, 170.0, 12)
    m = free_geneva(5)
    early = {"far": first("wheel.theta", above=1.5), "late": first("crank.theta", below=-9.0, give="wheel.omega")}
    short, whole = (
        m.simulate_many(
            3.0, start={"crank": degrees}, moving={"crank": -9.0}, measure=measure, steps=300, formulation="independent"
        )
        for measure in (early, {**early, "end": final("crank.theta")})
    )
    assert short.alone == [None] * 12, short.way
    for name in early:
        assert np.array_equal(short[name], whole[name], equal_nan=True)
    assert np.isfinite(short["far"]).any()


def test_a_row_that_cannot_start_has_its_reason_beside_others() -> None:
    many = free_geneva(5).simulate_many(
        1.0, vary={"index": {"radius": [0.1 * math.sin(math.pi / 5), 0.07]}}, measure={"end": final("wheel.theta")},
        steps=4, formulation="independent",
    )  # fmt: skip
    assert many.good.tolist() == [True, False]
    assert "its radius must be" in str(many.reason[1])


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
    assert worker.is_possible(packed, t, y)
    y[1, 0, 3] = -0.2
    assert not worker.is_possible(packed, t, y)
    assert worker.is_possible(packed, t[:1], y[:1])


def test_a_row_begins_with_all_its_joints() -> None:
    many = sling().simulate_many(
        1.2, vary={"spring": {"torque": [4.0, 4.0, 0.0, 4.0]}}, measure={"y": final("arm.y")}, steps=STEPS, threads=1
    )
    assert many["y"][0] == many["y"][1] == many["y"][3]
    assert many["y"][2] == pytest.approx(1.0, abs=1e-12)


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


def test_rows_are_exchanged_for_steps_in_which_all_contacts_are_open_as_well() -> None:
    m = cranks(12.0, stops=True)
    asked = request_for(m, 1.0, STEPS, None, "dop853", 1e-9, None, "auto", {})
    parts = Base(single_run(m, asked)).parts
    assert parts.contacts.schur.rows is parts.dyn.schur.rows
    assert parts.contacts.schur.rows.flags.writeable


def test_machines_with_many_rows_are_prepared_a_few_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    vary, measure = (
        {"coupler": {"mass": [0.5, 0.7, 1.0, 2.0]}},
        {"own": largest("A1.fy"), "theta": final("crank2.theta")},
    )
    given = []
    for most in (worker.GRAMS_AT_ONCE, 0, 2 * 12**2):
        monkeypatch.setattr(worker, "GRAMS_AT_ONCE", most)
        many = cranks(stops=True).simulate_many(1.0, vary=vary, measure=measure, steps=10, threads=1)
        assert many.alone == [None] * 4
        assert "anew" in many.way
        given.append(many)
    for name in measure:
        np.testing.assert_array_equal(given[0][name], given[1][name])
        np.testing.assert_array_equal(given[0][name], given[2][name])


def test_rows_that_start_inside_or_jam_say_so_and_do_not_stop_others() -> None:
    m = Mechanism("pushed", gravity=None)
    arm = m.bar("arm", 0.5, mass=1.0)
    m.revolute("pivot", m.ground.origin, arm.start)
    m.angle_stop("stop", m.ground.origin, arm.start, 0.5, upper=True, restitution=0.5)
    m.torsion_spring("spring", m.ground, arm, 2.0, 0.1)
    m.start_near(arm=0)
    many = m.simulate_many(0.5, start={"arm": [-30.0, 60.0, 10.0]}, measure={"a": largest("arm.theta")}, steps=20)
    assert many.good.tolist() == [True, False, True]
    assert "'stop' starts" in str(many.reason[1])
    assert np.isnan(many["a"]).tolist() == [False, True, False]
    assert many["a"][0] <= 0.5 + 1e-9


def test_steps_of_pins_without_contacts_have_the_digits_of_all_others(monkeypatch: pytest.MonkeyPatch) -> None:
    def measured() -> Any:
        many = barrier(stops=True).simulate_many(
            0.6,
            vary={"spring": {"damping": [0.1, 0.3, 0.8]}},
            measure={"angle": final("rocker.theta"), "force": largest("D.fy"), "back": smallest("rocker.omega")},
            steps=60,
            threads=1,
        )
        assert many.alone == [None] * 3
        return [many[name].tolist() for name in ("angle", "force", "force_time", "back")]

    by_pins = measured()
    monkeypatch.setattr(made, "PINS", 1000)
    assert measured() == by_pins


def test_only_pins_that_are_all_rows_go_their_own_way() -> None:
    def pins(m: Mechanism) -> int:
        return len(contacts_of_run(m).schur.pins)

    def contacts_of_run(m: Mechanism) -> Any:
        asked = request_for(m, 0.5, 10, None, "dop853", 1e-7, None, "auto", {})
        return single_run(m, asked).contacts

    assert pins(barrier(stops=True)) == 4
    assert pins(ball()) == pins(bumpers()) == 0
    dry = barrier(stops=True)
    dry.friction("dry", "D", coefficient=0.1, radius=0.01)
    assert pins(dry) == 0


def test_rows_whose_friction_is_refused_or_none_are_prepared_by_themselves() -> None:
    given = {"friction": [0.0, 0.2, 0.3], "static_friction": [0.0, 0.3, 0.2], "restitution": 0.5}
    many = rough_ball().simulate_many(0.5, vary={"floor": given}, measure={"x": final("ball.x")}, steps=4)
    assert many.good.tolist() == [True, True, False]
    assert "static friction" in str(many.reason[2])
    for k in range(2):
        m = rough_ball()
        m.change("floor", friction=given["friction"][k], static_friction=given["static_friction"][k], restitution=0.5)
        np.testing.assert_allclose(many["x"][k], m.simulate(0.5, steps=4).body("ball").x[-1], atol=1e-12)


def test_rows_that_end_early_and_threads_change_no_digit() -> None:
    """Rows are put away and taken up again while blocks slide and stick."""
    vary = {"spring": {"stiffness": [20.0, 50.0, 90.0, 120.0]}}
    early = {"when": first("block.x", above=0.03), "how": first("block.x", above=0.03, give="block.vx")}
    single, double = (belt().simulate_many(2.0, vary=vary, measure=early, steps=400, threads=n) for n in (1, 2))
    whole = belt().simulate_many(2.0, vary=vary, measure=early | {"x": final("block.x")}, steps=400)
    assert single.alone == [None] * 4, single.way
    assert np.isfinite(single["when"]).any()
    for name in early:
        np.testing.assert_array_equal(single[name], double[name])
        np.testing.assert_array_equal(single[name], whole[name])


def test_wheels_that_may_meet_go_in_the_loop_up_to_where_they_do() -> None:
    many = loose_gears().simulate_many(
        1.5, vary={"coil": {"stiffness": [0.0, 3.0]}}, measure={"x": final("gear.x")}, steps=10
    )
    assert many.good.tolist() == [False, True]
    assert many.alone[1] is None
    assert "'mesh' meet at t = " in str(many.reason[0])
    np.testing.assert_allclose(many["x"][1], loose_gears(3.0).simulate(1.5, steps=10).body("gear").x[-1], atol=1e-9)


def test_numbers_of_friction_vary_and_jamming_rows_say_so() -> None:
    """A rod that slides into the floor: from some friction on there is no motion (Painleve)."""
    rows = [0.2, 0.5, 2.5]
    m = rod()
    many = m.simulate_many(0.3, vary={"tip": {"friction": rows}}, measure={"x": final("rod.x")}, steps=10)
    assert many.good.tolist() == [True, True, False]
    with pytest.raises(SimulationError) as jams:
        rod(rows[2]).simulate(0.3, steps=10)
    assert str(jams.value) in str(many.reason[2])
    for k in range(2):
        expected = rod(rows[k]).simulate(0.3, steps=10).body("rod").x[-1]
        np.testing.assert_allclose(many["x"][k], expected, atol=2e-9)
