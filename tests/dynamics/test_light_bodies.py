"""Point masses beside bodies of other masses: closed forms, whatever else is in the model, in all units."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, MobilityError
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
