"""Events, contacts and stops that last a moment, between the places at which a step is looked at."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, ModelWarning, angle_reaches, distance_reaches, polynomial, speed_reaches
from mbsd.measures import final


def _pendulum() -> Mechanism:
    m = Mechanism("pendulum")
    arm = m.bar("arm", 1.0, mass=1.0)
    m.revolute("hinge", m.ground.origin, arm.start)
    m.start_near(arm=-30)
    return m


def _coasting() -> Mechanism:
    m = Mechanism("sledge", gravity=None)
    m.body("sledge", 1.0, inertia=1.0)
    m.start_moving(sledge=(1.0, 0.0, 0.0))
    return m


@pytest.mark.parametrize("near", [0.05, 5e-3, 1e-4, 1e-6, 1e-8])
def test_a_tip_that_passes_a_point_comes_near_and_leaves(near: float) -> None:
    """It is nearer than ``near`` for 2 near / v: by energy v^2 = 3 g (sin 30 deg fallen by height)."""
    m = _pendulum()
    angle = 0.2 - math.pi / 2
    m.event("near", distance_reaches(m.ground.at(math.cos(angle), math.sin(angle)), m.bodies["arm"].end, near))
    came, left = (event.time for event in m.simulate(1.0, steps=4, tolerance=1e-10).events)
    speed = math.sqrt(3 * 9.80665 * (-0.5 - math.sin(angle)))
    assert left - came == pytest.approx(2 * near / speed, rel=2e-3)
    passed = _pendulum()
    passed.event("there", angle_reaches(passed.bodies["arm"], angle))
    (there,) = (event.time for event in passed.simulate(1.0, steps=4, tolerance=1e-10).events)
    assert 0.5 * (came + left) == pytest.approx(there, abs=1e-9 + 0.1 * near**2)


def test_directions_ends_and_steps_do_not_matter_to_a_short_event() -> None:
    angle = 0.2 - math.pi / 2
    times = {}
    for direction, terminal in ((1, False), (-1, False), (-1, True)):
        for steps in (3, 50):
            m = _pendulum()
            value = distance_reaches(m.ground.at(math.cos(angle), math.sin(angle)), m.bodies["arm"].end, 1e-3)
            m.event("near", value, direction=direction, terminal=terminal)
            sol = m.simulate(1.0, steps=steps, tolerance=1e-10)
            times[direction, terminal, steps] = sol.events[0].time
            assert len(sol.events) == 1
            assert not terminal or sol.t[-1] == sol.events[0].time
    assert times[-1, False, 3] == pytest.approx(times[-1, True, 50], abs=1e-9)
    assert times[1, False, 3] == pytest.approx(times[1, False, 50], abs=1e-9)
    assert times[1, False, 3] > times[-1, False, 3]


@pytest.mark.parametrize("share", [1.0001, 1.001, 1.1])
def test_a_table_that_shakes_hardly_more_than_gravity_throws_its_load(share: float) -> None:
    """It leaves where A w^2 sin(w t) = g, for a flight of micrometres."""
    w, gravity = 40.0, 9.80665
    reach = share * gravity / w**2
    m = Mechanism("shaker")
    table, load = m.body("table", 1.0, inertia=1.0), m.body("load", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0, math.pi / 2), table.at(0, 0, math.pi / 2))
    m.drive_coordinate("motor", m.ground.at(0, 0, math.pi / 2), table.origin, lambda t: reach * math.sin(w * t))
    m.rigid_contact("touch", table.origin, load.origin)
    m.start_moving(load=(0.0, reach * w, 0.0))
    sol = m.simulate(0.6, steps=6)
    opens = [event.time for event in sol.events if event.what == "opens"]
    expected = (math.asin(1 / share) + 2 * math.pi * np.arange(len(opens))) / w
    assert len(opens) == 4
    np.testing.assert_allclose(opens, expected, atol=1e-4)


def test_a_stop_that_is_touched_for_a_moment_and_a_thin_wall() -> None:
    for depth in (1e-3, 1e-7):
        m = Mechanism("swing", gravity=None)
        arm = m.bar("arm", 1.0, mass=1.0)
        hinge = m.revolute("hinge", m.ground.origin, arm.start)
        m.torsion_spring("spring", m.ground, arm, 10.0)
        m.stop("end", hinge, lower=-1.0 + depth, restitution=1.0)
        m.start_near(arm=math.degrees(1.0))
        hits = [event.time for event in m.simulate(2.0, steps=4, tolerance=1e-10).events if event.what == "impact"]
        period = 2 * math.pi / math.sqrt(10.0 / (1 / 3))
        assert len(hits) >= 1, depth
        assert hits[0] == pytest.approx(period * math.acos(-1.0 + depth) / (2 * math.pi), abs=1e-6)
    m = _coasting()
    m.rigid_discs("wire", m.ground.at(0.123, 0), m.bodies["sledge"].origin, radius_i=1e-6, radius_j=1e-6)
    assert m.simulate(1.0, steps=2).events[0].what == "impact"


def test_functions_that_change_fast_are_resolved_or_said_not_to_be() -> None:
    m = _coasting()
    m.event("wave", lambda t, moment: math.sin(2 * math.pi * 30 * t) - 0.3)
    assert len(m.simulate(1.0, steps=4).events) == 60
    m = _coasting()
    m.event("wave", lambda t, moment: math.sin(1e6 * t) + 1.5)
    with pytest.warns(ModelWarning, match=r"event 'wave' changes too often .* Give shortest= \(s\)"):
        m.simulate(1.0, steps=4)
    pulse = _coasting()
    pulse.event("pulse", lambda t, moment: 1 - 2 * math.exp(-(((t - 0.3333) / 1e-4) ** 2)), shortest=1e-4)
    times = [event.time for event in pulse.simulate(1.0, steps=4).events]
    np.testing.assert_allclose(times, 0.3333 + np.array([-1, 1]) * 1e-4 * math.sqrt(math.log(2)), atol=1e-9)
    with pytest.raises(ModelError, match=r"event 'other': shortest is -1\.0 s; it must be a positive time"):
        pulse.event("other", lambda t, moment: t, shortest=-1)


def test_going_on_from_a_terminal_event_goes_on() -> None:
    """Whichever side of zero rounding has left the value on."""
    for offset in (0.0, 1.7e-16, -1.7e-16):
        m = _pendulum()
        m.event("end", lambda t, moment, offset=offset: moment.body("arm").theta + 1.0 + offset, terminal=True)
        ended = m.simulate(5.0, steps=10)
        m.start_near(arm=math.degrees(ended.body("arm").theta[-1]))
        m.start_moving(arm=ended.body("arm").omega[-1])
        again = m.simulate(5.0, steps=10)
        assert again.t[-1] > 0.5  # on its way back
        assert len(again.events) == 1


def test_an_action_that_turns_the_motion_back_acts_once() -> None:
    m = _coasting()
    m.event(
        "wall",
        lambda t, moment: moment.body("sledge").x - 0.5,
        action=lambda moment: moment.set_velocity("sledge", -moment.body("sledge").vx, 0.0, 0.0),
    )
    sol = m.simulate(1.0, steps=4)
    assert len(sol.events) == 1
    np.testing.assert_allclose(sol.body("sledge").x, [0, 0.25, 0.5, 0.25, 0], atol=1e-12)


@pytest.mark.parametrize("place", 0.3 + 0.0371 * np.arange(12))
def test_an_event_ends_where_it_ends_though_rounding_gives_its_begin_either_sign(place: float) -> None:
    m = _coasting()

    def value(t, moment):
        x = moment.body("sledge").x
        return abs(x - place) - 1e-5 + 1e-15 * math.sin(1e18 * x)

    m.event("near", value)
    times = [event.time for event in m.simulate(1.0, steps=4).events]
    np.testing.assert_allclose(times, [place - 1e-5, place + 1e-5], rtol=0, atol=1e-11)


@pytest.mark.parametrize("tolerance", [1e-7, 1e-9, 1e-11])
def test_a_tip_passes_near_points_of_its_arc_wherever_steps_end(tolerance: float) -> None:
    """Its speed changes by much within a step beside the turning point, so that the distance is bent there."""
    for angle in np.linspace(-31.0, -40.0, 60):
        m = _pendulum()
        tip = m.bodies["arm"].at(1.0, 0.0)
        place = m.ground.at(math.cos(math.radians(angle)), math.sin(math.radians(angle)))
        m.event("near", distance_reaches(place, tip, 1e-5))
        times = [event.time for event in m.simulate(0.8, steps=10, tolerance=tolerance).events]
        assert len(times) == 2, angle
        assert times[1] - times[0] < 2e-3


@pytest.mark.parametrize(("preload", "angles"), [(22.0, (90, 50)), (35.0, (98, 54)), (29.0, (91, 85))])
def test_a_step_with_no_time_within_it_has_no_events_of_rounding(preload: float, angles: tuple[int, int]) -> None:
    """Such a step is left where the last but one ends beside the end of a run; one joint rests, the others begin."""
    m = Mechanism("five-bar")
    a, b = m.bar("a", 0.3, mass=1.5), m.bar("b", 0.5, mass=1.1)
    c, d = m.bar("c", 0.45, mass=0.7), m.bar("d", 0.25, mass=1.3)
    m.revolute("A", m.ground.origin, a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", c.start, d.end)
    m.revolute("E", m.ground.at(0.4, 0), d.start)
    for pin in "ABCDE":
        m.friction(f"rub {pin}", pin, 0.2, static=0.35, radius=0.03, preload=preload, sticks=True)
    m.start_near(a=angles[0], b=45.0, c=100.0, d=angles[1])
    sol = m.simulate(4e-10, steps=1, tolerance=1e-6)
    assert [(event.name, event.what) for event in sol.events] == [("rub A", "sticks")]
    assert sol.t[-1] == 4e-10


G = 9.81


def falling_arm(level: float, noted: bool = False) -> Mechanism:
    """A bar that falls about its hinge until it turns at ``level`` (rad/s), and then flies, turning as fast."""
    m = Mechanism("loose", gravity=(0, -G))
    arm = m.bar("arm", 1.0, mass=1.0)
    hinge = m.revolute("hinge", m.ground.at(0, 0), arm.start)
    m.event("gone", speed_reaches(arm, level), releases=[hinge])
    if noted:
        m.event("seen", speed_reaches(arm, level))
    m.start_near(arm=0)
    return m


def fall(level: float) -> float:
    """Angle (rad) at which a falling bar turns at ``level`` (rad/s): w^2 = 3 g sin(angle) / l, downwards."""
    return -math.asin(level**2 / (3 * G))


@settings(max_examples=30, suppress_health_check=[HealthCheck.too_slow])
@given(
    level=st.floats(-4.5, -0.2).map(lambda level: round(level, 3)),
    tolerance=st.sampled_from([1e-4, 1e-7, 1e-10]),
    steps=st.sampled_from([2, 50]),
    noted=st.booleans(),
)
def test_a_bar_that_keeps_its_speed_in_free_flight_lets_go_once(
    level: float, tolerance: float, steps: int, noted: bool
) -> None:
    sol = falling_arm(level, noted).simulate(2.0, steps=steps, tolerance=tolerance)
    names = [event.name for event in sol.events]
    assert names.count("gone") == 1
    assert names.count("seen") <= 1  # it is at its level when the bar lets go, on whichever side rounding has it
    near = 1e-9 + 30.0 * tolerance
    np.testing.assert_allclose(sol.body("arm").omega[-1], level, atol=near)
    when = sol.events[0].time
    np.testing.assert_allclose(sol.body("arm").theta[-1], fall(level) + level * (2.0 - when), atol=10.0 * near)


@numba.njit
def brake(t: float, q: np.ndarray, v: np.ndarray) -> tuple[float, float, float]:
    """Slows from 2 to 3 s, and speeds up from 3 to 5 s, by 1 rad/s^2."""
    return 0.0, 0.0, -1.0 if 2.0 < t <= 3.0 else 1.0 if 3.0 < t < 5.0 else 0.0


@pytest.mark.parametrize("shift", [0.0, 0.3], ids=["as it is", "turned"])
def test_it_happens_again_where_it_left_zero_and_comes_back(shift: float) -> None:
    """A motor lets go of a wheel at 2 rad/s, which then turns as fast for a second."""
    m = Mechanism("wheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=1.0)
    m.revolute("axle", m.ground.at(0, 0, shift), wheel.at(0, 0, -shift))
    motor = m.drive_angle("motor", wheel, polynomial(0.0, 0.0, 1.0))
    m.event("fast", speed_reaches(wheel, 2.0), releases=[motor])
    m.user_force("brake", brake, wheel)
    sol = m.simulate(6.0, steps=600)
    assert [event.name for event in sol.events] == ["fast", "fast"]
    np.testing.assert_allclose([event.time for event in sol.events], [1.0, 4.0], atol=1e-4)
    np.testing.assert_allclose(sol.body("wheel").omega[-1], 3.0, atol=1e-4)
    many = m.simulate_many(6.0, measure={"w": final("wheel.omega")}, vary={"wheel": {"inertia": [1.0]}}, steps=600)
    np.testing.assert_allclose(many["w"], sol.body("wheel").omega[-1], atol=1e-7)


def test_names_of_columns_need_no_event() -> None:
    """An action that fails at the start is the reason of its rows, not an error of the call."""
    m = Mechanism("bad", gravity=None)
    body = m.body("stone", 1.0, inertia=1.0)
    m.event("now", lambda t, moment: t - 5e-10, action=lambda moment: 1 / 0)
    many = m.simulate_many(1.0, moving={"stone": [(1.0, 0.0, 0.0)]}, measure={"x": final(f"{body.name}.x")}, steps=4)
    assert not many.good.any()
    assert "now" in str(many.reason[0])


ANGLE = 0.2
C, S = math.cos(ANGLE), math.sin(ANGLE)
LANDS = math.sqrt(2 * 0.05 / (9.80665 * C))
DURATIONS = [0.28, 0.35, 0.57, 1.02, 1.25, 1.7]
"""s; events came at other times in each, or ended in an error of scipy."""


def thrown_box() -> Mechanism:
    """A box that falls onto a slope and slides down it on two feet."""
    m = Mechanism("box")
    box = m.body("box", 2.0, (0.0123, 0.0331), inertia=0.01)
    for name, x in (("left", -0.1), ("right", 0.1)):
        m.rigid_contact(name, m.ground.at(0, 0, ANGLE), box.at(x, 0, 0), friction=0.1)
    m.start_near(box=(-0.05 * S, 0.05 * C, math.degrees(ANGLE)))
    m.start_moving(box=(3.0 * C, 3.0 * S, 0))
    return m


@numba.njit
def leaving(t: float, q: np.ndarray, v: np.ndarray) -> float:
    """The speed away from the slope (m/s)."""
    return -S * v[0] + C * v[1]


@numba.njit
def sign(t: float, q: np.ndarray, v: np.ndarray) -> float:
    """Its sign."""
    return 1.0 if leaving(t, q, v) > 0.0 else -1.0


@pytest.mark.parametrize("duration", DURATIONS)
@pytest.mark.parametrize("value", [leaving, sign])
def test_a_speed_that_a_contact_takes_away_comes_to_zero_once_and_then(value, duration: float) -> None:  # type: ignore[no-untyped-def]
    m = thrown_box()
    m.event("lies", value, frames=[m.bodies["box"].origin])
    times = [event.time for event in m.simulate(duration, steps=10).events if event.name == "lies"]
    assert times == [pytest.approx(LANDS, rel=1e-9)]


def test_a_block_that_friction_stops_has_stopped() -> None:
    """Its speed comes to zero just when the contact begins to hold it."""
    m = Mechanism("block")
    block = m.body("block", 2.0, inertia=1.0)
    m.rigid_contact("floor", m.ground.origin, block.origin, friction=0.4)
    m.start_near(block=(0, 0, 0))
    m.start_moving(block=(1.0, 0, 0))
    m.event("stops", lambda t, moment: moment.body("block").vx, direction=-1, terminal=True)
    for duration in (0.5, 1.0, 3.0):
        sol = m.simulate(duration)
        assert sol.events[-1].what == "end"
        assert sol.t[-1] == pytest.approx(1.0 / (0.4 * 9.80665), rel=1e-9)


def test_what_rounding_alone_decides_is_an_error_that_names_the_event() -> None:
    """The angular velocity of a box on two feet is zero but for rounding."""
    refused = []
    for duration in np.linspace(0.7, 2.0, 12):
        m = thrown_box()
        m.event("odd", lambda t, moment: 0.5 - t if moment.body("box").omega > 0 else t - 0.7)
        try:
            m.simulate(float(duration), steps=10)
        except ModelError as error:
            refused.append(str(error))
    assert refused
    assert all("event 'odd' at t = " in words and "smooth in time and motion" in words for words in refused)
