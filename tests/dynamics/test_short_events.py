"""Events, contacts and stops that last a moment, between the places at which a step is looked at."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, ModelWarning, angle_reaches, distance_reaches


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
