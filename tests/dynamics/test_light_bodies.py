"""Point masses beside bodies of other masses: closed forms, whatever else is in the model, in all units."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, MobilityError, ModelError, constant_rate
from mbsd.measures import final, smallest

G = 9.80665
OTHERS = [None, 1e-6, 1e-3, 1e3, 1e6]


def pendulum(other: float | None = None, start: float = -60.0, length: float = 0.1, mass: float = 0.1) -> Mechanism:
    """A point mass on a pin, and a wheel of mass ``other`` (kg) that nothing connects to it."""
    m = Mechanism("pendulum")
    bob = m.body("bob", mass, com=(length, 0.0))
    m.revolute("O", m.ground.origin, bob.origin)
    if other is not None:
        m.revolute("W", m.ground.at(length, 0.0), m.body("wheel", other, inertia=0.1 * other * length**2).origin)
    m.start_near(bob=start)
    return m


pytestmark = pytest.mark.filterwarnings("ignore::mbsd.ModelWarning")


@pytest.mark.parametrize("other", OTHERS)
def test_small_swings_have_the_rate_of_a_mathematical_pendulum(other: float | None) -> None:
    assert pendulum(other, -90.0).modes()[-1].omega == pytest.approx(math.sqrt(G / 0.1), rel=1e-12)


@pytest.mark.parametrize("formulation", ["auto", "reference"])
@pytest.mark.parametrize("other", OTHERS)
def test_the_pin_carries_the_weight_and_the_centrifugal_force(other: float | None, formulation: str) -> None:
    """m g (3 cos - 2 cos 0), angles from the vertical."""
    sol = pendulum(other).simulate(0.4, steps=20, tolerance=1e-12, formulation=formulation)
    hung = np.cos(sol.body("bob").theta + math.pi / 2)
    tension = np.hypot(*sol.joint("O").reaction.T)
    assert tension == pytest.approx(0.1 * G * (3.0 * hung - 2.0 * hung[0]), rel=1e-9)


@pytest.mark.parametrize("other", OTHERS)
def test_a_stop_takes_momentum_and_energy_of_the_mass_alone(other: float | None) -> None:
    m = pendulum(other, 0.0)
    m.stop("end", "O", lower=math.radians(-80.0), restitution=0.5)
    sol = m.simulate(0.25, steps=5, tolerance=1e-12)
    speed = math.sqrt(2.0 * G * 0.1 * math.sin(math.radians(80.0)))
    assert sol.events[0].impulse == pytest.approx(1.5 * 0.1 * speed * 0.1, rel=1e-10)
    assert sol.events[0].energy == pytest.approx(-0.75 * 0.5 * 0.1 * speed**2, rel=1e-10)
    many = m.simulate_many(
        0.25, steps=5, tolerance=1e-12, start={"bob": [0.0, -10.0]}, measure={"rate": final("bob.omega")}
    )
    assert many["rate"][0] == pytest.approx(sol.body("bob").omega[-1], rel=1e-9)


@pytest.mark.parametrize("method", ["rattle", "radau"])
def test_other_integrators_are_as_exact(method: str) -> None:
    options: dict[str, Any] = {"step": 1e-4} if method == "rattle" else {"tolerance": 1e-10}
    alone, beside = (pendulum(other).simulate(0.02, steps=4, method=method, **options) for other in (None, 1e6))
    assert beside.body("bob").theta == pytest.approx(alone.body("bob").theta, rel=1e-9)
    assert beside.joint("O").reaction == pytest.approx(alone.joint("O").reaction, rel=1e-8)


def hook(arm: float, jib_mass: float = 1e3, jib: float = 5.0) -> Mechanism:
    """A point mass of 1 kg that hangs on the end of a heavy jib."""
    m = Mechanism("crane")
    m.revolute("O", m.ground.origin, m.bar("jib", jib, jib_mass).start)
    m.revolute("P", m.bodies["jib"].end, m.body("hook", 1.0, com=(arm, 0.0)).origin)
    m.start_near(jib=20, hook=-50)
    return m


@pytest.mark.parametrize("formulation", ["auto", "reference"])
@pytest.mark.parametrize("arm", [2e-2, 1e-3])
def test_a_hook_on_a_heavy_jib(arm: float, formulation: str) -> None:
    """The two equations of a double pendulum, solved by hand."""
    sol = hook(arm).simulate(1e-3, steps=1, formulation=formulation)
    length, heavy, a, b = 5.0, 1e3, math.radians(20.0), math.radians(-50.0)
    mass = np.array(
        [
            [heavy * length**2 / 3.0 + length**2, length * arm * math.cos(a - b)],
            [length * arm * math.cos(a - b), arm**2],
        ]
    )
    load = -G * np.array([(heavy / 2.0 + 1.0) * length * math.cos(a), arm * math.cos(b)])
    alpha = np.linalg.solve(mass, load)
    assert (sol.body("jib").alpha[0], sol.body("hook").alpha[0]) == pytest.approx(alpha, rel=1e-10)
    pull = [-length * alpha[0] * math.sin(a) - arm * alpha[1] * math.sin(b),
            length * alpha[0] * math.cos(a) + arm * alpha[1] * math.cos(b) + G]  # fmt: skip
    assert sol.joint("P").reaction[0] == pytest.approx(pull, rel=1e-9)


@given(
    st.floats(-6.0, 6.0),
    st.floats(-3.0, 3.0),
    st.floats(-3.0, 3.0),
    st.floats(-170.0, -10.0),
)
@settings(max_examples=25, deadline=None)
def test_other_bodies_and_units_change_nothing(other: float, length: float, mass: float, start: float) -> None:
    """Masses by 10^m and lengths by 10^l, gravity too, beside a body of 10^other times the mass."""

    def motion(other: float | None, unit: float, kilogram: float) -> tuple[np.ndarray, np.ndarray]:
        m = pendulum(other, start, 0.1 * unit, 0.1 * kilogram)
        second = m.bar("rod", 0.2 * unit)
        m.revolute("Q", m.bodies["bob"].at(0.15 * unit, 0.0), second.start)
        m.revolute("R", second.end, m.body("end", 0.02 * kilogram).origin)
        m.gravity = (0.0, -G * unit)
        m.start_near(rod=start + 30.0)
        m.start_moving(bob=2.0)
        sol = m.simulate(0.05, steps=2, tolerance=1e-12, formulation="reference")
        force = sol.joint("O").reaction / (unit * kilogram)
        return np.stack([sol.body("bob").theta, sol.body("rod").theta, sol.body("bob").omega]), force

    plain = motion(None, 1.0, 1.0)
    scaled = motion(0.1 * 10.0 ** (mass + other), 10.0**length, 10.0**mass)
    for expected, got in zip(plain, scaled, strict=True):
        assert got == pytest.approx(expected, rel=1e-9, abs=1e-9 * float(np.abs(expected).max()))


def cart(angle: float = -90.0) -> Mechanism:
    m = Mechanism("cart")
    wagon = m.body("wagon", 2.0)
    m.prismatic("rail", m.ground.origin, wagon.origin)
    m.revolute("P", wagon.origin, m.body("bob", 0.3, com=(0.25, 0.0)).origin)
    m.start_near(bob=angle, wagon=(0.0, 0.0, 0.0))
    m.start_moving(wagon=(1.5, 0.0, 0.0))
    return m


@pytest.mark.parametrize("heavy", [False, True])
def test_a_velocity_that_is_not_given_has_the_least_energy_of_the_masses(heavy: bool) -> None:
    """The mass below the wagon stays where it is; a mass beside it swings so that it only follows along the rod."""
    m = cart()
    if heavy:
        m.revolute("W", m.ground.at(3.0, 0.0), m.body("wheel", 1e6, inertia=1e4).origin)
    assert m.simulate(0.01, steps=1).body("bob").omega[0] == pytest.approx(-1.5 / 0.25, rel=1e-12)
    angles = np.array([-90.0, -60.0, -30.0])
    many = m.simulate_many(0.01, steps=1, start={"bob": angles}, measure={"rate": smallest("bob.omega")})
    for angle, rate in zip(angles, many["rate"], strict=True):
        single = cart(angle).simulate(0.01, steps=1, tolerance=1e-7).body("bob").omega
        assert single[0] == pytest.approx(1.5 * math.sin(math.radians(angle)) / 0.25, rel=1e-12)
        assert rate == pytest.approx(single.min(), rel=1e-9)


def test_a_push_meets_the_mass_alone() -> None:
    m = pendulum(1e6, -90.0)
    end = m.bodies["bob"].at(0.1, 0.0)
    m.event("hit", lambda t, moment: 0.01 - t, action=lambda moment: moment.push(end, 0.02, 0.0))
    sol = m.simulate(0.011, steps=11)
    assert sol.body("bob").omega[-1] == pytest.approx(0.02 / (0.1 * 0.1), rel=1e-3)


def loose_behind_a_clutch(m: Mechanism) -> None:
    wheel, drum = m.body("wheel", 1.0, inertia=0.01), m.body("drum", 1.0)
    m.revolute("O", m.ground.origin, wheel.origin)
    m.revolute("P", m.ground.origin, drum.origin)
    m.one_way("clutch", wheel, drum)
    m.torque("motor", wheel, 0.1)


def loose_on_a_stop(m: Mechanism) -> None:
    m.stop("clutch", m.revolute("P", m.ground.origin, m.body("drum", 1.0).origin), lower=-1.0)


def loose_on_a_corner(m: Mechanism) -> None:
    m.rigid_contact("clutch", m.ground.at(0.0, -0.2), m.body("drum", 1.0).at(0.1, 0.0))


def loose_on_a_spring(m: Mechanism) -> None:
    """At rest at first: its load begins later."""
    m.revolute("P", m.ground.origin, m.body("drum", 1.0).origin)
    m.torsion_spring("clutch", "ground", "drum", 3.0)


@pytest.mark.parametrize("build", [loose_behind_a_clutch, loose_on_a_stop, loose_on_a_corner, loose_on_a_spring])
def test_what_turns_a_point_mass_alone_is_an_error(build: Any) -> None:
    m = Mechanism("loose")
    build(m)
    m.start_near(drum=0)
    says = r"body 'drum' has no inertia in angle, .*'clutch.*m\.change\('drum'"
    with pytest.raises(MobilityError, match=says):
        m.simulate(0.1, steps=2)
    with pytest.raises(MobilityError, match=says):
        m.simulate_many(0.1, steps=2, moving={"drum": [0.0, 1.0]}, measure={"rate": final("drum.omega")})
    m.change("drum", inertia=0.02)
    m.simulate(0.1, steps=2)


def test_a_point_mass_that_is_pushed_through_its_middle_bounces() -> None:
    m = Mechanism("ball")
    m.rigid_contact("floor", m.ground.origin, m.body("ball", 1.0).origin, restitution=0.5)
    m.start_near(ball=(0.0, 0.2, 0.0))
    sol = m.simulate(0.3, steps=3)
    assert sol.events[0].impulse == pytest.approx(1.5 * math.sqrt(2.0 * G * 0.2), rel=1e-8)


def _double_pendulum(lower: float, upper: float = 1.0) -> Mechanism:
    m = Mechanism("pendulum")
    first, second = m.bar("first", 1.0, mass=upper), m.bar("second", 1.0, mass=lower)
    m.revolute("hook", m.ground.origin, first.start)
    m.revolute("elbow", first.end, second.start)
    m.start_near(first=-60, second=-30)
    return m


def _four_bar(coupler: float, base: float | None = None) -> Mechanism:
    m = Mechanism("linkage")
    frame = m.ground
    if base is not None:
        frame = m.body("base", mass=base, inertia=base)
        m.weld("weld", m.ground.origin, frame.origin)
    a, b, c = m.bar("a", 0.3, mass=1.0), m.bar("b", 1.0, mass=coupler), m.bar("c", 0.8, mass=1.0)
    m.revolute("A", frame.origin, a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", frame.at(1.0, 0), c.start)
    m.start_near(a=60, b=20, c=100)
    return m


@pytest.mark.parametrize("formulation", ["reference", "independent"])
@pytest.mark.parametrize("ratio", [1e9, 1e12])
def test_motion_and_reactions_are_those_of_a_massless_upper_link(ratio: float, formulation: str) -> None:
    """Divided by the ratio they differ by parts of its inverse, below what integration leaves."""
    sol = _double_pendulum(ratio).simulate(3.0, steps=30, formulation=formulation)
    limit = _double_pendulum(1.0, upper=0.0).simulate(3.0, steps=30, tolerance=1e-10)
    assert sol.stats.steps < 200
    np.testing.assert_allclose(sol.body("second").theta, limit.body("second").theta, atol=1e-5)
    force, expected = np.hypot(sol.joint("hook").fx, sol.joint("hook").fy), np.hypot(*_hook(limit))
    np.testing.assert_allclose(force / ratio, expected, rtol=1e-4, atol=1e-4)
    assert sol.stats.acceleration_residual < 1e-10


def _hook(sol) -> tuple[np.ndarray, np.ndarray]:
    return sol.joint("hook").fx, sol.joint("hook").fy


def test_formulations_agree_on_a_closed_loop_with_a_heavy_coupler() -> None:
    reference = _four_bar(1e9).simulate(2.0, steps=20, formulation="reference", tolerance=1e-9)
    independent = _four_bar(1e9).simulate(2.0, steps=20, formulation="independent", tolerance=1e-9)
    np.testing.assert_allclose(
        reference.joint("A").fx, independent.joint("A").fx, atol=1e-5 * np.abs(independent.joint("A").fx).max()
    )
    assert reference.stats.steps < 2 * independent.stats.steps


def test_what_rounding_would_decide_is_refused_with_the_bodies() -> None:
    with pytest.raises(ModelError, match=r"pendulum: body 'first' is joined on to 'second', .* 1\.\de\+15 times apart"):
        _double_pendulum(1e15).simulate(1.0)
    _double_pendulum(1e-15).simulate(0.2)  # a light body that hangs at a heavy one costs no digits


def test_a_light_base_on_ground_costs_no_digits() -> None:
    """A frame that a weld holds on ground is ground: it need not weigh much beside a machine of 1e12 kg."""
    based = _four_bar(1e12, base=1e-3).simulate(1.0, steps=10, formulation="reference", tolerance=1e-9)
    plain = _four_bar(1e12).simulate(1.0, steps=10, formulation="reference", tolerance=1e-9)
    assert based.stats.steps < 2 * plain.stats.steps
    np.testing.assert_allclose(based.body("b").theta, plain.body("b").theta, atol=1e-6)
    force = based.joint("weld")
    np.testing.assert_allclose(force.fx, based.joint("A").fx + based.joint("D").fx, rtol=1e-6)


@pytest.mark.parametrize("inertia", [1e-3, 1e-6, 1e-9, 0.0])
@pytest.mark.parametrize("mass", [0.01, 0.0])
def test_a_slider_that_rests_at_its_dead_centre_keeps_its_own_mass(mass: float, inertia: float) -> None:
    """Everything rests but the crank and the rod's big end at the start; the slider is not held by ground for it."""
    m = Mechanism("press", gravity=(0.0, -9.81))
    crank, rod, slider = m.bar("crank", 0.04, mass=0.012), m.bar("rod", 0.12, mass=0.03), m.body("slider")
    m.change("slider", mass=mass, inertia=inertia)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.drive_angle("motor", crank, constant_rate(2 * np.pi))
    m.start_near(crank=0, rod=0, slider=0)
    simulated, swept = m.simulate(duration=1.0, steps=90), m.sweep(duration=1.0, steps=90)
    for joint in "OAB":
        np.testing.assert_allclose(simulated.joint(joint).force, swept.joint(joint).force, atol=1e-9)
    assert simulated.stats.power_residual < 1e-12


def on_a_pin() -> Mechanism:
    m = Mechanism("m")
    m.revolute("A", m.ground.origin, m.bar("rod", 0.5).start)
    return m


def free() -> Mechanism:
    m = Mechanism("m")
    m.body("rod")
    return m


def beside_a_heavy_one() -> Mechanism:
    m = on_a_pin()
    m.revolute("B", m.ground.at(1, 0), m.bar("heavy", 0.5, 1.0).start)
    return m


def at_a_point_mass() -> Mechanism:
    m = Mechanism("m")
    ball = m.body("ball", 1.0)
    m.revolute("A", ball.origin, m.bar("rod", 0.5).start)
    return m


def spring_between() -> Mechanism:
    """At rest at first, so that no load shows it."""
    m = Mechanism("m", gravity=None)
    rod = m.body("rod")
    m.prismatic("guide", m.ground.origin, rod.origin)
    m.spring("spring", m.ground.origin, rod.at(0.1, 0.0), 10.0, free_length=0.1)
    m.start_near(rod=(0, 0, 0))
    return m


@pytest.mark.parametrize("make", [on_a_pin, free, beside_a_heavy_one, at_a_point_mass, spring_between])
@pytest.mark.parametrize("formulation", ["auto", "reference"])
def test_a_loose_one_is_refused(make: Callable[[], Mechanism], formulation: str) -> None:
    with pytest.raises(
        MobilityError, match=r"m: 'rod' has neither mass nor inertia, .* m\.change\('rod', mass=\.\.\.\)"
    ):
        make().simulate(0.1, steps=2, formulation=formulation)
    with pytest.raises(MobilityError, match="'rod'"):
        make().linearise(at="start")
    m = make()
    m.change("rod", mass=1.0, inertia=0.1)
    m.simulate(0.1, steps=2)


def carried() -> Mechanism:
    """A rod without mass between the ground and a point mass."""
    m = on_a_pin()
    m.revolute("B", m.bodies["rod"].end, m.body("ball", 1.0).origin)
    return m


def driven() -> Mechanism:
    m = on_a_pin()
    m.drive_angle("motor", m.bodies["rod"], constant_rate(2.0))
    return m


def a_point_mass() -> Mechanism:
    m = Mechanism("m")
    m.body("ball", 1.0)
    return m


def held() -> Mechanism:
    m = a_point_mass()
    m.weld("W", m.ground.origin, m.bar("rod", 0.5).start)
    return m


@pytest.mark.parametrize("make", [carried, driven, a_point_mass, held])
def test_others_move(make: Callable[[], Mechanism]) -> None:
    make().simulate(0.1, steps=2)
