"""Contacts with friction in the compiled loop over simulations: what single simulations of the same rows give."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, SimulationError, harmonic
from mbsd.measures import final, first, samples
from tools.models.loose_gears import loose_gears

pytestmark = pytest.mark.slow
G = 9.81
STEPS = 30
Start = dict[str, tuple[float, float, float]]


def incline(friction: float = 0.4, static: float | None = None, slope: float = 25.0) -> Mechanism:
    """A box on two feet, thrown up an incline: it slides, stops, stays or comes back, or tips."""
    m = Mechanism("incline", gravity=(0, -G))
    box = m.body("box", 1.0, inertia=0.01)
    for name, x in (("rear", -0.15), ("front", 0.15)):
        m.rigid_contact(
            name, m.ground.at(0, 0, math.radians(slope)), box.at(x, -0.05), friction=friction, static_friction=static
        )
    c, s = math.cos(math.radians(slope)), math.sin(math.radians(slope))
    m.start_near(box=(-0.05 * s, 0.05 * c, slope))
    m.start_moving(box=(1.5 * c, 1.5 * s, 0))
    return m


def ball(friction: float = 0.2, restitution: float = 0.6) -> Mechanism:
    """A ball between floor and wall, thrown with spin."""
    m = Mechanism("ball", gravity=(0, -G))
    ball = m.body("ball", 0.2, inertia=0.4 * 0.2 * 0.05**2)
    m.rigid_contact("floor", m.ground.at(0, 0), ball.origin, 0.05, restitution, friction)
    m.rigid_contact("wall", m.ground.at(0.5, 0, math.pi / 2), ball.origin, 0.05, restitution, friction)
    m.start_near(ball=(0, 0.4, 0))
    m.start_moving(ball=(1.0, 0, 40))
    return m


def tumbling(friction: float = 0.3, restitution: float = 0.3) -> Mechanism:
    """A box with four corners, thrown."""
    m = Mechanism("tumbling", gravity=(0, -G))
    box = m.body("box", 1.0, inertia=0.02)
    for k, (x, y) in enumerate(((-0.2, -0.1), (0.2, -0.1), (0.2, 0.1), (-0.2, 0.1))):
        m.rigid_contact(f"corner {k}", m.ground.at(0, 0), box.at(x, y), 0.0, restitution, friction)
    m.start_near(box=(0, 0.6, 20))
    m.start_moving(box=(1.0, 0, -3))
    return m


def belt(friction: float = 0.3, static: float = 0.5) -> Mechanism:
    """A block on a base that swings to and fro, held by a spring: it sticks and slips."""
    m = Mechanism("belt", gravity=(0, -G))
    base, block = m.body("base", 1.0, inertia=1.0), m.body("block", 1.0, inertia=0.01)
    m.prismatic("rail", m.ground.origin, base.origin)
    m.drive_coordinate("motor", m.ground.origin, base.origin, harmonic(0.1, 6.0))
    for name, x in (("rear", -0.1), ("front", 0.1)):
        m.rigid_contact(name, base.at(0, 0), block.at(x, -0.05), friction=friction, static_friction=static)
    m.spring("spring", m.ground.at(-1, 0.05), block.origin, 50.0, 0.5, free_length=1.0)
    m.start_near(base=(0, 0, 0), block=(0, 0.05, 0))
    return m


def crank() -> Mechanism:
    """A linkage that pushes a rough block along the floor and pulls it back."""
    m = Mechanism("crank", gravity=(0, -G))
    crank, rod, block = m.bar("crank", 0.1, mass=0.3), m.bar("rod", 0.4, mass=0.2), m.body("block", 2.0, inertia=0.02)
    m.revolute("O", m.ground.at(0, 0.1), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, block.at(0, 0.02))
    for name, x in (("rear", -0.1), ("front", 0.1)):
        m.rigid_contact(name, m.ground.at(0, 0), block.at(x, -0.05), friction=0.3)
    m.torque("motor", crank, 1.5)
    m.start_near(crank=60, rod=-10, block=(0.44, 0.05, 0))
    return m


def hills() -> Mechanism:
    """A wheel on rough hills: it rolls, slips, flies."""
    m = Mechanism("hills", gravity=(0, -G))
    wheel = m.body("wheel", 0.5, inertia=0.5 * 0.5 * 0.1**2)
    points = [(x, 0.2 * math.sin(2 * x) - 0.1 * x) for x in np.linspace(-2.0, 6.0, 60)]
    m.rigid_terrain("road", m.ground.origin, wheel.origin, points, 0.1, restitution=0.2, friction=0.25)
    m.start_near(wheel=(-0.5, 0.5, 0))
    m.start_moving(wheel=(2.0, 0, 0))
    return m


def test_rows_whose_friction_is_refused_or_none_are_prepared_by_themselves() -> None:
    given = {"friction": [0.0, 0.2, 0.3], "static_friction": [0.0, 0.3, 0.2], "restitution": 0.5}
    many = ball().simulate_many(0.5, vary={"floor": given}, measure={"x": final("ball.x")}, steps=4)
    assert many.good.tolist() == [True, True, False]
    assert "static friction" in str(many.reason[2])
    for k in range(2):
        m = ball()
        m.change("floor", friction=given["friction"][k], static_friction=given["static_friction"][k], restitution=0.5)
        np.testing.assert_allclose(many["x"][k], m.simulate(0.5, steps=4).body("ball").x[-1], atol=1e-12)


def rod(friction: float = 0.2) -> Mechanism:
    m = Mechanism("rod", gravity=(0, -G))
    rod = m.body("rod", 1.0, inertia=1.0 / 12)
    m.rigid_contact("tip", m.ground.at(0, 0), rod.at(-0.5, 0), friction=friction)
    angle = math.radians(40)
    m.start_near(rod=(0.5 * math.cos(angle), 0.5 * math.sin(angle), 40))
    m.start_moving(rod=(-2.0, 0, 0))
    return m


def discs() -> Mechanism:
    """Two discs on the floor that roll into each other."""
    m = Mechanism("discs", gravity=(0, -G))
    a, b = m.body("a", 1.0, inertia=0.005), m.body("b", 0.5, inertia=0.001)
    for name, body, radius in (("floor a", a, 0.1), ("floor b", b, 0.06)):
        m.rigid_contact(name, m.ground.at(0, 0), body.origin, radius, 0.3, 0.2)
    m.rigid_discs("pair", a.origin, b.origin, 0.1, 0.06, restitution=0.5, friction=0.3)
    m.start_near(a=(-0.4, 0.1, 0), b=(0.1, 0.2, 0))
    m.start_moving(a=(2.0, 0, -20), b=(-0.5, 0, 10))
    return m


def ring() -> Mechanism:
    """A disc within a rolling ring, whose centres pass each other: steps may take them half their way alone."""
    m = Mechanism("ring", gravity=(0, -G))
    ring, disc = m.body("ring", 1.0, inertia=0.05), m.body("disc", 0.3, inertia=0.001)
    m.rigid_contact("floor", m.ground.at(0, 0), ring.origin, 0.3, 0.0, 0.5)
    m.rigid_discs("pair", ring.origin, disc.origin, 0.28, 0.06, True, 0.8, 0.3)
    m.start_near(ring=(0, 0.3, 0), disc=(0.15, 0.302, 0))
    m.start_moving(ring=(1.0, 0, 0), disc=(-2.0, 0, 10))
    return m


def freewheel() -> Mechanism:
    """A rolling disc pushed to and fro, with a flywheel that it takes along one way alone."""
    m = Mechanism("freewheel", gravity=(0, -G))
    disc, fly = m.body("disc", 1.0, inertia=0.005), m.body("fly", 0.5, inertia=0.003)
    m.rigid_contact("floor", m.ground.at(0, 0), disc.origin, 0.1, 0.2, 0.4)
    m.revolute("axle", disc.origin, fly.origin)
    m.one_way("ratchet", disc, fly)
    m.spring("spring", m.ground.at(0, 0.1), disc.origin, 80.0, 0.2, free_length=0.5)
    m.start_near(disc=(0.8, 0.15, 0), fly=(0.8, 0.15, 0))
    return m


CASES: dict[str, tuple[Callable[[], Mechanism], float, dict[str, Any], str]] = {
    "stops": (incline, 1.0, {"rear": {"friction": [0.3, 0.6, 0.9]}}, "box"),
    "static": (lambda: incline(0.3, 0.7), 1.0, {"box": {"inertia": [0.005, 0.02]}}, "box"),
    "steep": (lambda: incline(0.3, slope=40.0), 1.0, {"box": {"mass": [0.5, 2.0]}}, "box"),
    "ball": (ball, 2.0, {"ball": {"inertia": [1e-4, 2e-4, 4e-4]}}, "ball"),
    "tumbling": (tumbling, 1.5, {"corner 0": {"friction": [0.1, 0.5]}}, "box"),
    "belt": (belt, 2.0, {"spring": {"stiffness": [20.0, 50.0, 120.0]}}, "block"),
    "crank": (crank, 1.0, {"motor": {"torque": [0.5, 1.5, 3.0]}}, "block"),
    "hills": (hills, 2.0, {"wheel": {"inertia": [1e-3, 2.5e-3, 5e-3]}}, "wheel"),
    "freewheel": (freewheel, 1.5, {"spring": {"stiffness": [50.0, 80.0, 200.0]}}, "fly"),
    "discs": (discs, 0.8, {"a": {"mass": [1.0, 1.4]}}, "b"),
    "ring": (ring, 0.5, {"disc": {"mass": [0.3, 0.4]}}, "disc"),
}


def compare(build: Callable[[], Mechanism], duration: float, vary: dict[str, Any], body: str) -> list[set[str]]:
    """Simulate rows in the loop and by themselves; what happened in each of the single ones."""
    times = np.linspace(0.0, duration, STEPS + 1)
    measures: dict[str, Any] = {part: samples(f"{body}.{part}", times.tolist()) for part in ("x", "y", "theta")}
    measures |= {"omega": final(f"{body}.omega"), "work": final("work")}
    joint = next(iter(build().joints), None)
    if joint is not None:
        measures["fx"] = samples(f"{joint}.fx", times.tolist())
    many = build().simulate_many(duration, vary=vary, measure=measures, steps=STEPS)
    assert many.alone == [None] * len(many), many.way
    assert "anew" not in many.way
    (name, values), *_ = vary.items()
    happened = []
    for k in range(len(many)):
        m = build()
        m.change(name, **{key: column[k] for key, column in values.items()})
        sol = m.simulate(duration, steps=STEPS)
        happened.append({event.what for event in sol.events})
        for part in ("x", "y", "theta"):
            np.testing.assert_allclose(many[part][k], getattr(sol.body(body), part), atol=2e-9, err_msg=f"{k} {part}")
        np.testing.assert_allclose(many["omega"][k], sol.body(body).omega[-1], atol=1e-7)
        if joint is not None:
            np.testing.assert_allclose(many["fx"][k], sol.joint(joint).fx, rtol=1e-6, atol=1e-6)
        assert sol.work is not None
        np.testing.assert_allclose(many["work"][k], sol.work[-1], atol=1e-8)
    return happened


@pytest.mark.parametrize("case", CASES)
def test_friction_is_that_of_single_simulations(case: str) -> None:
    happened = compare(*CASES[case])
    assert all(happened)


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
    compare(loose_gears, 0.9, {"coil": {"stiffness": [0.0, 1.0, 3.0]}}, "gear")
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


def thrown(
    slope: float,
    friction: float,
    above: float,
    restitution: float,
    feet: int,
    swing: float,
    spring: float,
    moving: Start,
) -> Mechanism:
    """A body on some feet above a plane that swings to and fro, tied to ground by a spring, thrown."""
    m = Mechanism("thrown", gravity=(0, -G))
    base, body = m.body("base", 1.0, inertia=1.0), m.body("body", 1.0, inertia=0.02)
    m.prismatic("rail", m.ground.at(0, 0, math.radians(slope)), base.origin)
    m.drive_coordinate("motor", m.ground.at(0, 0, math.radians(slope)), base.origin, harmonic(swing, 9.0))
    for k in range(feet):
        angle = -math.pi / 2 + (k - 0.5 * (feet - 1)) * 0.9
        foot = body.at(0.2 * math.cos(angle), 0.2 * math.sin(angle))
        m.rigid_contact(f"foot {k}", base.origin, foot, 0.02, restitution, friction, friction * (1 + above))
    m.spring("spring", m.ground.at(0, 1), body.origin, spring, 0.1, free_length=0.8)
    m.start_near(base=(0, 0, slope), body=(0, 0.5, slope))
    m.start_moving(**moving)
    return m


@settings(max_examples=25)
@given(
    slope=st.floats(-30, 30),
    friction=st.floats(0.05, 0.9),
    above=st.sampled_from([0.0, 0.0, 0.3]),
    restitution=st.sampled_from([0.0, 0.3, 0.7]),
    feet=st.integers(1, 4),
    swing=st.sampled_from([0.0, 0.02, 0.1]),
    spring=st.sampled_from([0.0, 20.0]),
    speed=st.tuples(st.floats(-2, 2), st.floats(-2, 1), st.floats(-10, 10)),
)
def test_random_bodies_thrown_onto_a_rough_plane(speed: tuple[float, float, float], **given: Any) -> None:
    compare(lambda: thrown(moving={"body": speed}, **given), 1.0, {"body": {"mass": [1.0, 1.3]}}, "body")
