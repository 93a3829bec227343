"""Joints that slide beside bodies at rest, joints without friction, bodies that hold each other while at rest."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import fsolve

from mbsd import Mechanism, harmonic, polynomial
from mbsd.measures import final, samples
from tools.models.rough import carried_five_bar, dragged_arm, pushed_block, pusher

TIMES = np.linspace(0.0, 1.0, 21)


def thrown_chain(lengths: tuple[float, ...], starts: tuple[tuple[float, float, float], ...], **numbers) -> Mechanism:
    """Three bars that fall on a rough plane; two come to lie on it while the first turns on its dry pin."""
    m = Mechanism("chain", gravity=numbers["gravity"])
    places, last = {}, None
    for k, (length, mass, start) in enumerate(zip(lengths, numbers["masses"], starts, strict=True)):
        bar = m.bar(f"bar{k}", length, mass=mass)
        if last is not None:
            m.revolute(f"P{k}", last.end, bar.start)
            rub, preload = numbers["pins"][k - 1]
            m.friction(f"rub {k}", f"P{k}", rub, radius=0.02, preload=preload)
        kinetic, static = numbers["floor"]
        m.rigid_contact(f"tip{k}", m.ground.at(0, 0), bar.end, 0.01, numbers["restitution"], kinetic, static)
        places[f"bar{k}"], last = start, bar
    m.start_near(**places)
    return m


def drawn_chain() -> Mechanism:
    return thrown_chain(
        (1 / 3, 0.3635905816197978, 0.4499364978283497),
        ((0.0, 0.5, 4.716697551), (0.3322044884532743, 0.5274096509, 0.0), (0.69579507, 0.5274096509, -37.656216457)),
        gravity=(0, -9.81),
        masses=(1.9, 0.3057589663168389, 1.6131558561858959),
        pins=((0.39059551703586526, 11.995333765818355), (0.2982419381307455, 24.491337122141598)),
        floor=(0.5369023442370257, 0.7516632819318358),
        restitution=0.3,
    )


def tilted_chain() -> Mechanism:
    return thrown_chain(
        (0.3391574234344522, 0.20136540080403034, 1 / 3),
        ((0.0, 0.492397074, -25.693933), (0.305622532, 0.345350735, 0.0), (0.506987933, 0.345350735, -15.7262457)),
        gravity=(-4.703164533707231, -8.609084932144556),
        masses=(1.0, 0.3, 1.314788509333237),
        pins=((0.18509142085587088, 2.0), (0.2085055448926974, 2.6845456791798874)),
        floor=(0.6706532284418136, 0.938914519818539),
        restitution=0.0,
    )


@pytest.mark.parametrize("build", [drawn_chain, tilted_chain])
def test_bars_that_lie_give_way_to_one_that_turns_beside_them(build) -> None:
    """They share what holds them, and with it what presses the turning pin: it came to no end who slips."""
    m = build()
    own = ("x", "theta", "omega")
    measure = {part: samples(f"bar0.{part}", TIMES.tolist()) for part in own}
    many = m.simulate_many(vary={"bar0": {"mass": [m.bodies["bar0"].mass]}}, measure=measure, times=TIMES)
    sol = m.simulate(times=TIMES)
    slips = [event.time for event in sol.events if event.what == "slides" and event.name in ("tip1", "tip2")]
    assert len(slips) >= 2
    assert len(set(slips)) < len(slips), "they lie on one line and give way together"
    assert many.reason[0] is None
    assert many.alone[0] is None, many.alone[0]
    for part in own:
        np.testing.assert_allclose(many[part][0], getattr(sol.body("bar0"), part), atol=1e-6)
    fine = m.simulate(times=TIMES, tolerance=1e-11)
    np.testing.assert_allclose(sol.body("bar0").theta, fine.body("bar0").theta, atol=1e-5)


COEFFICIENTS = st.one_of(st.just(0.0), st.floats(0.05, 0.4))


@settings(max_examples=15, deadline=None)
@given(
    coefficients=st.lists(COEFFICIENTS, min_size=3, max_size=3).filter(lambda each: 0.0 in each),
    masses=st.lists(st.floats(0.5, 2.0), min_size=3, max_size=3),
    pulls=st.lists(st.tuples(st.floats(0.0, 12.0), st.floats(1.0, 4.0)), min_size=3, max_size=3),
    tilt=st.sampled_from([0.0, 0.0, -1.0, 0.7]),
)
def test_a_joint_with_a_coefficient_of_zero_moves_as_one_without_friction(
    coefficients: list[float], masses: list[float], pulls: list[tuple[float, float]], tilt: float
) -> None:
    def sledges(rubs: list[float | None]) -> Mechanism:
        m = Mechanism("sledges", gravity=(tilt, -9.81))
        below = m.ground
        for k, (rub, mass, pull) in enumerate(zip(rubs, masses, pulls, strict=True)):
            body = m.body(f"sledge{k}", mass, inertia=1.0)
            m.prismatic(f"on{k}", below.origin, body.origin)
            if rub is not None:
                m.friction(f"rub{k}", f"on{k}", rub, sticks=True)
            m.force(f"pull{k}", body.origin, harmonic(*pull))
            below = body
        m.start_near(sledge0=(0, 0, 0), sledge1=(0, 0, 0), sledge2=(0, 0, 0))
        return m

    m, bare = sledges(coefficients), sledges([rub or None for rub in coefficients])
    sol, other = m.simulate(times=TIMES, tolerance=1e-10), bare.simulate(times=TIMES, tolerance=1e-10)
    without = {f"rub{k}" for k, rub in enumerate(coefficients) if rub == 0.0}
    assert not without & {event.name for event in sol.events}
    assert [(e.name, e.what) for e in sol.events] == [(e.name, e.what) for e in other.events]
    for k in range(3):
        name = f"sledge{k}"
        np.testing.assert_allclose(sol.body(name).x, other.body(name).x, atol=1e-7)
        assert f"rub{k}" not in without or not sol.friction(f"rub{k}").force.any()
    measure = {"x": samples("sledge2.x", TIMES.tolist())}
    many = m.simulate_many(vary={"sledge2": {"mass": masses[2:]}}, measure=measure, times=TIMES, tolerance=1e-10)
    assert many.alone[0] is None
    np.testing.assert_allclose(many["x"][0], sol.body("sledge2").x, atol=1e-8)


def test_a_block_gives_way_to_a_linkage_that_pressed_it_down_while_it_held() -> None:
    """Torques of dry pins at rest turn the rod onto the block, whose feet hold more by that, and end with the rest."""
    angle, rubbing = 84.8264358, {"rear": (0.2, 0.2), "front": (0.2, 0.2)}
    m = pusher(True, "OAB", 2.3037288079360136, (0.2, 0.5), rubbing, (0.5, 4.843645223170216), angle)
    sol, fine = (m.simulate(times=TIMES, tolerance=tolerance) for tolerance in (1e-8, 1e-11))
    begins = [event.time for event in sol.events if event.what == "slides"]
    assert {event.name for event in sol.events if event.time == begins[0]} >= {
        "rear",
        "front",
        "rub O",
        "rub A",
        "rub B",
    }
    assert begins[0] == pytest.approx(0.07533634, abs=1e-5)
    np.testing.assert_allclose(sol.body("part").x, fine.body("part").x, atol=1e-6)
    still = begins[0] > TIMES
    assert np.ptp(sol.body("part").x[still]) < 1e-12
    assert np.ptp(sol.body("part").x) > 0.01


G = 9.81
RATE = 2.0
STATIC, FLOOR, RADIUS, PRELOAD = 0.24, 0.3, 0.02, 20.0
"""Pins and feet with friction, as tools/models/rough.py has them."""


def greatest_torque(crank: float, rod: float, senses: tuple[float, float, float]) -> float:
    """The torque on the crank at which all pins and feet are at their limits, by statics alone.

    crank, rod: angles (rad); ``senses``: directions in which O, A, B are about to turn. The block goes forwards or
    backwards with the crank.
    """
    r, length = 0.1, 0.4
    a = np.array([r * math.cos(crank), r * math.sin(crank)])
    b = length * np.array([math.cos(rod), math.sin(rod)])
    forwards = -math.copysign(1.0, senses[0] * math.sin(crank - rod))

    def cross(p: np.ndarray, f: np.ndarray) -> float:
        return float(p[0] * f[1] - p[1] * f[0])

    def equations(unknown: np.ndarray) -> list[float]:
        at_o, at_a, at_b = unknown[0:2], unknown[2:4], unknown[4:6]  # on crank, rod and block
        rear, front, torque = unknown[6:]
        forces = [np.linalg.norm(f) for f in (at_o, at_a, at_b)]
        limit = [STATIC * RADIUS * (float(f) + PRELOAD) * sense for f, sense in zip(forces, senses, strict=True)]
        down = np.array([0.0, -G])
        on_crank = at_o - at_a + 0.3 * down
        on_rod = at_a - at_b + 0.2 * down
        on_block = at_b + 2.0 * down + np.array([-FLOOR * forwards * (rear + front), rear + front])
        return [
            *on_crank,
            cross(a, -at_a) + cross(0.5 * a, 0.3 * down) + torque - limit[0] + limit[1],
            *on_rod,
            cross(b, -at_b) + cross(0.5 * b, 0.2 * down) - limit[1] + limit[2],
            *on_block,
            cross(np.array([0.0, 0.02]), at_b) - limit[2]
            + 0.1 * (front - rear) - 0.05 * FLOOR * forwards * (rear + front),
        ]  # fmt: skip

    start = np.array([0.0, 5.0, 0.0, 3.0, 0.0, 1.0, 10.0, 10.0, 0.5])
    out, _, solved, _ = fsolve(equations, start, full_output=True, xtol=1e-13)
    assert solved == 1
    return float(out[-1])


def test_a_crank_breaks_away_at_the_torque_of_statics() -> None:
    """Three pins and two feet hold one freedom together: none gives way before all are at their limits."""
    sol = pushed_block(True, torque=polynomial(0.0, RATE), preload=PRELOAD).simulate(0.6, steps=60)
    breaks = [event.time for event in sol.events if event.name.startswith("rub") and event.what == "slides"][-1]
    stops = [event.time for event in sol.events if event.name == "rub O" and event.what == "sticks"][-1]
    k = int(np.searchsorted(sol.t, breaks)) - 1
    assert stops < sol.t[k]
    crank, rod = (float(sol.body(name).theta[k]) for name in ("crank", "rod"))
    late = [float(sol.body(name).omega[-1]) for name in ("crank", "rod")]
    senses = tuple(math.copysign(1.0, rate) for rate in (late[0], late[1] - late[0], -late[1]))
    assert RATE * breaks == pytest.approx(greatest_torque(crank, rod, senses), rel=1e-7)


def test_a_weak_joint_behind_a_strong_one_breaks_away() -> None:
    """Its limit is small beside the accelerations that the strong joint prevents."""
    m = Mechanism("arm")
    upper, fore = m.bar("upper", 0.5, 1.0), m.bar("fore", 0.4, 0.7)
    m.revolute("shoulder", m.ground.origin, upper.start)
    m.revolute("elbow", upper.end, fore.start)
    m.friction("strong", "shoulder", 0.3, radius=0.05, preload=2e5, sticks=True)
    m.friction("weak", "elbow", 0.3, radius=0.05, preload=1.0, sticks=True)
    m.torque("pull", fore, polynomial(0.0, 1.0))
    m.start_near(upper=0, fore=-90)
    sol = m.simulate(0.5, steps=10)
    breaks = [event.time for event in sol.events if event.name == "weak" and event.what == "slides"]
    assert breaks[0] == pytest.approx(0.3 * 0.05 * (0.7 * 9.80665 + 1.0), rel=1e-9)


@pytest.mark.parametrize("build", [dragged_arm, carried_five_bar])
def test_what_joints_share_agrees_with_the_motion_where_contacts_slide(build) -> None:
    """Contacts push as the motion of the whole machine asks, whatever its joints at rest carry."""
    m = build(True)
    sol = m.simulate(0.5, steps=20)
    pins = [f"rub {pin}" for pin in "ABCDEPQ" if pin in m.joints]
    assert {e.name for e in sol.events if e.what == "sticks"} == set(pins)
    bodies = [name for name in m.bodies if name != "ground"]
    momentum = sum(m.bodies[name].mass * sol.body(name).ax for name in bodies)
    normal, friction = (sum(getattr(sol.contact(name), part) for name in m.contacts) for part in ("normal", "friction"))
    np.testing.assert_allclose(friction, momentum, atol=1e-9)
    np.testing.assert_allclose(friction, -FLOOR * normal, atol=1e-9)


def test_joints_with_several_freedoms_share_on_a_sledge_that_slides() -> None:
    """Four joints of a five-bar turn in the motion that would give way first, with the same part of their limits."""
    sol = carried_five_bar(True).simulate(0.5, steps=20)
    joints = [sol.friction(f"rub {pin}") for pin in "ABCDE"]
    parts = np.sort([np.abs(each.force) / (0.24 * 0.02 * (each.normal + 1000.0)) for each in joints], axis=0)[:, 1:]
    np.testing.assert_allclose(parts[1:], np.broadcast_to(parts[-1], (4, 20)), rtol=1e-9)
    assert (parts[0] < 0.9 * parts[-1]).all()


STANDARD = 9.80665


@pytest.mark.parametrize("speed", [0.0, 5e-6, 2e-5])
def test_a_rebound_too_slow_to_count_frees_no_joint(speed: float) -> None:
    """A lever that static friction alone holds, and a ball that leaves it so slowly that it stays."""
    m = Mechanism("lifted lever")
    lever, ball = m.body("lever", 1.0, inertia=0.1), m.body("ball", 0.5, inertia=1e-3)
    m.revolute("pin", m.ground.origin, lever.origin)
    m.friction("rub", "pin", 0.2, static=0.5, stribeck=1e-6, radius=0.2, sticks=True)
    m.rigid_contact("touch", lever.origin, ball.origin, radius=0.02)
    m.torque("lift", lever, 0.5 * STANDARD * 0.3 + 0.9 * 0.5 * 0.2 * 1.5 * STANDARD)
    m.start_near(lever=0, ball=(0.3, 0.02, 0))
    m.start_moving(ball=(0.0, speed, 0.0))
    sol = m.simulate(0.3, steps=30)
    assert sorted((event.name, event.what) for event in sol.events) == [("rub", "sticks"), ("touch", "closes")]
    np.testing.assert_allclose(sol.body("lever").theta, 0.0, atol=1e-15)
    np.testing.assert_allclose(sol.body("ball").y, 0.02, atol=1e-15)
    many = m.simulate_many(0.3, vary={"ball": {"mass": [0.5]}}, measure={"angle": final("lever.theta")}, steps=30)
    assert many.alone == [None], many.way
    assert abs(many["angle"][0]) < 1e-15
