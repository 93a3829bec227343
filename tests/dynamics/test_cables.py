"""Cables over pulleys and drums: closed forms, constant length, energy, and the errors of bad ways."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import AssemblyError, LimitError, Mechanism, ModelError, SimulationError, constant_rate, measures

G = 9.80665
DOWN = -math.pi / 2


def hanging(m: Mechanism, name: str, x: float, y: float, mass: float) -> Any:
    """Add a load that moves up and down at x, and starts at y."""
    body = m.body(name, mass=mass, inertia=0.1)
    m.prismatic(f"guide {name}", m.ground.at(x, 0, DOWN), body.at(0, 0, DOWN))
    m.start_near(**{name: (x, y, 0)})
    return body


def wheel(m: Mechanism, name: str, x: float, y: float, mass: float = 0.0, inertia: float = 0.0) -> Any:
    """Add a pulley on a pin of ground."""
    body = m.body(name, mass=mass, inertia=inertia)
    m.revolute(f"axle {name}", m.ground.at(x, y), body.origin)
    return body


@pytest.mark.parametrize("formulation", ["reference", "independent"])
def test_a_pulley_with_mass_makes_a_difference_of_tensions(formulation: str) -> None:
    """Atwood's machine: a = g (m1 - m2) / (m1 + m2 + I / r^2)."""
    m = Mechanism("atwood")
    pulley = wheel(m, "pulley", 0, 0, 2.0, 0.01)
    left, right = hanging(m, "left", -0.1, -1, 3.0), hanging(m, "right", 0.1, -1.5, 2.0)
    m.cable("rope", [left.origin, m.over(pulley.origin, 0.1), right.origin])
    sol = m.simulate(0.3, steps=10, formulation=formulation)
    a = G / (3.0 + 2.0 + 1.0)
    assert sol.body("right").ay == pytest.approx(np.full(11, a), rel=1e-11)
    assert sol.body("pulley").alpha == pytest.approx(np.full(11, a / 0.1), rel=1e-11)
    assert sol.tension("rope") == pytest.approx(np.array([[3.0 * (G - a), 2.0 * (G + a)]] * 11), rel=1e-11)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-11


@settings(max_examples=12, deadline=None)
@given(st.lists(st.floats(0.5, 20.0), min_size=1, max_size=4), st.floats(0.5, 20.0))
def test_tackles_of_any_masses(blocks: list[float], load: float) -> None:
    """T = g (2 n + 1) / (4 sum 1 / m_k + 1 / m), for n loose blocks that hang between fixed pulleys."""
    m, r = Mechanism("tackle"), 0.05
    way: list[Any] = [m.ground.origin]
    for k, mass in enumerate(blocks):
        block = hanging(m, f"block{k}", r + 4 * r * k, -1.0 - 0.1 * k, mass)
        way.append(m.over(block.origin, r, clockwise=False, slides=True))
        way.append(m.over(m.ground.at(3 * r + 4 * r * k, 0), r, slides=True))
    way.append(hanging(m, "load", 4 * r * len(blocks), -0.7, load).origin)
    m.cable("rope", way)
    sol = m.simulate(0.02, steps=2)
    tension = G * (2 * len(blocks) + 1) / (4 * sum(1 / mass for mass in blocks) + 1 / load)
    assert sol.tension("rope") == pytest.approx(np.full((3, len(way) - 1), tension), rel=1e-9)
    assert sol.body("load").ay == pytest.approx(np.full(3, tension / load - G), rel=1e-8, abs=1e-8)


@pytest.mark.parametrize("outer", [0.1, 0.13])
def test_a_differential_windlass_lifts_by_half_the_difference(outer: float) -> None:
    """Weston: a turn of the drums lifts pi (R - r), and the motor carries W (R - r) / 2."""
    m, inner = Mechanism("windlass"), 0.08
    drum, load = wheel(m, "drum", 0, 0), hanging(m, "load", outer - 0.5 * (outer + inner), -2.0, 20.0)
    half = 0.5 * (outer + inner)
    block = m.over(load.origin, half, clockwise=True, slides=True)
    m.cable("rope", [m.over(drum.origin, outer, clockwise=True), block, m.over(drum.origin, inner, clockwise=True)])
    m.drive_angle("motor", drum, constant_rate(1.0))
    sol = m.sweep(1.0, steps=20)
    assert sol.body("load").y - sol.body("load").y[0] == pytest.approx(0.5 * (outer - inner) * sol.t, abs=2e-12)
    assert sol.driver("motor").effort == pytest.approx(20.0 * G * 0.5 * (outer - inner) * np.ones(21), rel=1e-9)


def swinging() -> Mechanism:
    """Return two loads that swing on a cable over a fixed wheel, with a third on a loose pulley between."""
    m = Mechanism("swinging")
    loads = [m.body(name, mass=mass, inertia=0.02) for name, mass in (("a", 1.0), ("c", 2.0), ("b", 3.0))]
    m.start_near(a=(-0.5, -1.0, 0), c=(0.3, -1.4, 0), b=(0.9, -0.8, 0))
    fixed = [m.over(m.ground.at(x, 0), 0.1, slides=True) for x in (0.0, 0.6)]
    loose = m.over(loads[1].at(0.02, 0.03), 0.07, clockwise=False, slides=True)
    m.cable("rope", [loads[0].at(0.05, 0), fixed[0], loose, fixed[1], loads[2].origin])
    return m


def length_of(ways: list[tuple[np.ndarray, float]]) -> float:
    """Return the length of a cable along wheels (centre, signed radius): its tangents, and the arcs between them."""
    total, arrived = 0.0, 0.0
    for k, ((a, r), (b, s)) in enumerate(pairwise(ways)):
        gap = b - a
        total += math.sqrt(gap @ gap - (s - r) ** 2)
        along = math.atan2(gap[1], gap[0]) - math.asin((s - r) / math.hypot(*gap))
        if k:
            total += abs(r) * ((math.copysign(1.0, r) * (along - arrived)) % (2 * math.pi))
        arrived = along
    return total


def test_a_cable_keeps_its_length_and_the_energy() -> None:
    m = swinging()
    sol = m.simulate(1.0, steps=40, tolerance=1e-10)

    def at(body: str, x: float, y: float, k: int) -> np.ndarray:
        place = sol.place(m.bodies[body].at(x, y)) if body != "ground" else None
        return np.array([x, y]) if place is None else np.array([place.x[k], place.y[k]])

    lengths = [
        length_of(
            [
                (at("a", 0.05, 0, k), 0.0),
                (at("ground", 0, 0, k), -0.1),
                (at("c", 0.02, 0.03, k), 0.07),
                (at("ground", 0.6, 0, k), -0.1),
                (at("b", 0, 0, k), 0.0),
            ]
        )
        for k in range(41)
    ]
    assert np.ptp(lengths) < 1e-12
    assert np.ptp(sol.energy.total) < 1e-8
    assert np.ptp(sol.tension("rope"), axis=1).max() < 1e-9 * sol.tension("rope").max()


def test_a_slack_cable_carries_nothing_and_catches_without_giving_energy() -> None:
    def lifted(restitution: float) -> Any:
        m = Mechanism("lifted")
        left, right = hanging(m, "left", -0.1, -1, 3.0), hanging(m, "right", 0.1, -1, 1.0)
        m.start_moving(right=(0, 2.0, 0))
        over = m.over(m.ground.origin, 0.1, slides=True)
        m.cable("rope", [left.origin, over, right.origin], taut=False, slack=0.05, restitution=restitution)
        return m.simulate(0.4, steps=200, event_rows=True)

    sol = lifted(0.0)
    first = next(event for event in sol.events if event.what == "impact")
    y = sol.body("left").y + sol.body("right").y
    slack = 0.05 + y - y[0]
    assert slack.min() > -1e-9
    before = sol.t < first.time
    assert np.abs(sol.tension("rope")[before]).max() < 1e-12
    speed = -(2.0 - 2 * G * first.time)  # at which the way grows
    assert first.impulse == pytest.approx(speed / (1 / 3.0 + 1 / 1.0), rel=1e-9)
    assert first.energy == pytest.approx(-0.5 * speed**2 / (1 / 3.0 + 1 / 1.0), rel=1e-9)
    assert sol.tension("rope")[-1] == pytest.approx(np.full(2, 2 * G * 3.0 / 4.0), rel=1e-9)
    bounced = lifted(0.5)
    assert sum(event.what == "impact" for event in bounced.events) > 1
    assert all(event.energy <= 1e-12 for event in bounced.events)


def test_a_closed_belt_with_a_tensioner() -> None:
    """Three pulleys on one belt: rims run alike, and the arm stays where the belt's length holds it."""
    m = Mechanism("tensioner")
    first, second = wheel(m, "first", 0, 0, 1.0, 0.01), wheel(m, "second", 1, 0, 1.0, 0.02)
    arm, idler = m.bar("arm", 0.3, mass=0.5), m.body("idler", mass=0.2, inertia=0.001)
    m.revolute("pivot", m.ground.at(0.5, -0.5), arm.start)
    m.revolute("pin", arm.end, idler.origin)
    m.start_near(arm=100)
    spans = m.cable(
        "belt",
        [m.over(first.origin, 0.1), m.over(second.origin, 0.2), m.over(idler.origin, 0.05, clockwise=False)],
        closed=True,
    )
    m.drive_angle("motor", first, constant_rate(3.0))
    sol = m.sweep(2.0, steps=30)
    assert [span.name for span in spans] == ["belt 1", "belt 2", "belt 3"]
    assert sol.body("second").omega == pytest.approx(np.full(31, 1.5), rel=1e-12)
    assert sol.body("idler").omega == pytest.approx(np.full(31, -6.0), rel=1e-12)
    assert np.ptp(sol.body("arm").theta) < 1e-12


def test_many_at_once_and_derivatives_agree_with_single_runs() -> None:
    m = swinging()
    ends = {"end": measures.final("b.y")}
    many = m.simulate_many(0.5, vary={"b": {"mass": [3.0, 3.5]}}, measure=ends, tolerance=1e-10)
    alone = []
    for mass in (3.0, 3.5):
        m.change("b", mass=mass)
        alone.append(m.simulate(0.5, tolerance=1e-10).body("b").y[-1])
    assert many["end"] == pytest.approx(alone, rel=1e-9)
    m.change("b", mass=3.0)
    slope = m.sensitivities("b.y", "b.mass", duration=0.5, steps=5).of("b.y", "b.mass")[-1]
    step, ends = 1e-4, []
    for mass in (3.0 - step, 3.0 + step):
        m.change("b", mass=mass)
        ends.append(m.simulate(0.5, steps=5, tolerance=1e-11).body("b").y[-1])
    assert slope == pytest.approx((ends[1] - ends[0]) / (2 * step), rel=1e-6)


def test_loads_rest_where_their_weights_balance() -> None:
    """Two equal loads and one between them: half of its weight hangs on each strand, upright parts of equal pulls."""
    m = Mechanism("balance")
    ends = [m.body(name, mass=2.0, com=(0, -0.1), inertia=0.02) for name in ("a", "b")]
    middle = m.body("c", mass=3.0, com=(0, -0.1), inertia=0.02)
    m.start_near(a=(-0.5, -1.0, 0), c=(0.3, -0.4, 0), b=(1.1, -1.2, 0))
    fixed = [m.over(m.ground.at(x, 0), 0.1, slides=True) for x in (-0.4, 1.0)]
    m.cable("left", [ends[0].origin, fixed[0], middle.origin])
    m.cable("right", [middle.origin, fixed[1], ends[1].origin])
    rest = m.equilibrium()
    assert rest.stable
    for name in ("left", "right"):
        assert rest.solution.tension(name) == pytest.approx(np.full((1, 2), 2.0 * G), rel=1e-9)
    assert rest.solution.joint("right 1").fy == pytest.approx([-1.5 * G], rel=1e-9)


def test_a_cable_that_leaves_its_wheel_is_refused_with_the_time() -> None:
    """The load is pulled up on a guide beside the wheel, until the cable from the top of the drum is straight."""
    m = Mechanism("winch")
    drum, load = wheel(m, "drum", -1.0, 0), hanging(m, "load", 0.5, -0.5, 5.0)
    m.start_near(load=(0.5, -0.5, 0))
    m.cable("rope", [load.origin, m.over(m.ground.origin, 0.1, False, slides=True), m.over(drum.origin, 0.1, False)])
    m.drive_coordinate("motor", m.ground.at(0.5, 0, math.pi / 2), load.at(0, 0, math.pi / 2), constant_rate(0.1, -0.5))
    m.sweep(5.9, steps=50)
    with pytest.raises(LimitError, match=r"at t = 6 s the cable leaves 'rope wheel 1' between 'rope 1' and 'rope 2'"):
        m.sweep(7.0, steps=700)


def test_a_cable_is_saved_and_read(tmp_path: Any) -> None:
    m = swinging()
    m.save(tmp_path / "m.json")
    other = Mechanism.load(tmp_path / "m.json")
    assert other.simulate(0.2, steps=2).body("b").y.tolist() == m.simulate(0.2, steps=2).body("b").y.tolist()


@pytest.mark.parametrize(
    ("way", "options", "problem"),
    [
        (lambda m: [m.bodies["a"].origin], {}, "has 1 stations; it needs two ends"),
        (lambda m: "rope", {}, "needs its way as a list"),
        (lambda m: [m.bodies["a"], m.ground.origin], {}, "station 1 is"),
        (lambda m: [m.bodies["a"].origin, m.ground.at(0, 1), m.bodies["b"].origin], {}, "is a point of 'ground' betw"),
        (lambda m: [m.bodies["a"].origin, m.over(m.ground.origin, 0.1), m.bodies["b"].origin], {}, "slides=True"),
        (lambda m: [m.over(m.ground.origin, 0.1, slides=True), m.bodies["b"].origin], {}, "would slip off"),
        (lambda m: [m.bodies["a"].origin, m.bodies["b"].origin], {"slack": 0.1}, "say taut=False"),
        (lambda m: [m.bodies["a"].origin, m.bodies["b"].origin], {"closed": True}, "between its ends"),
    ],
)
def test_a_way_that_is_none_is_refused(way: Any, options: dict[str, Any], problem: str) -> None:
    m = Mechanism("wrong")
    for name in ("a", "b"):
        m.body(name, mass=1.0)
    with pytest.raises(ModelError, match=problem):
        m.cable("rope", way(m), **options)
    assert not m.joints
    assert len(m.bodies) == 3


def test_wheels_inside_each_other_are_refused_with_the_distance() -> None:
    m = Mechanism("inside")
    a, b = wheel(m, "a", 0, 0), wheel(m, "b", 0.25, 0)
    m.cable("rope", [m.over(a.origin, 0.2, clockwise=False), m.over(b.origin, 0.1)])
    m.drive_angle("motor", a, constant_rate(1.0))
    with pytest.raises(AssemblyError, match=r"0\.25 m apart.*crosses.*more than 0\.3 m"):
        m.sweep(1.0)
    with pytest.raises(ModelError, match="must be positive"):
        m.over(a.origin, 0.0)
    with pytest.raises(ModelError, match="it must be a marker"):
        m.over(a, 0.1)


@pytest.mark.parametrize("taut", [True, False])
def test_a_point_that_runs_into_its_wheel_ends_the_motion(taut: bool) -> None:
    """A load is thrown up along a guide that leads into the wheel."""
    m = Mechanism("meet")
    pulley, load = wheel(m, "pulley", 0, 0, 1.0, 0.1), hanging(m, "load", -0.05, -1.0, 1.0)
    m.start_moving(load=(0, 6.0, 0))
    m.cable("rope", [load.origin, m.over(pulley.origin, 0.1)], taut=taut)
    with pytest.raises(SimulationError, match=r"wheels of cable 'rope' meet at t = 0\.1[58].*needs 0\.1 m"):
        m.simulate(1.0, steps=10)


def test_a_slack_span_that_starts_inside_its_wheel_is_refused() -> None:
    m = Mechanism("inside")
    pulley, load = wheel(m, "pulley", 0, 0, 1.0, 0.1), hanging(m, "load", 0.0, -0.05, 1.0)
    m.cable("rope", [load.origin, m.over(pulley.origin, 0.1)], taut=False)
    with pytest.raises(AssemblyError, match=r"0\.05 m apart.*more than 0\.1 m"):
        m.simulate(1.0, steps=10)
