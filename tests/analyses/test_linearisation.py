"""Linearisation and modes: textbook frequencies, chains, moving states, inputs, and the nonlinear motion nearby."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import expm, logm
from scipy.special import jn_zeros

from mbsd import Mechanism, MobilityError, ModelError, SingularPoseError, constant_rate, harmonic
from tools.models import linkages

G = 9.81


def bob(m: Mechanism, name: str, length: float, mass: float = 1.0):
    """A point mass at the end of a massless rod: its frame is at the upper end."""
    return m.body(name, mass, com=(length, 0.0))


def test_pendulum() -> None:
    m = Mechanism("pendulum", gravity=(0.0, -G))
    rod = m.bar("rod", 0.8, mass=2.0)
    m.revolute("A", m.ground.at(0.3, 0.1), rod.start)
    m.start_near(rod=-50)
    [mode] = m.modes()
    assert mode.omega == pytest.approx(math.sqrt(1.5 * G / 0.8), rel=1e-9)
    assert mode.frequency == pytest.approx(mode.omega / (2 * math.pi))
    assert mode.damping_ratio == 0.0
    assert m.linearise().stability == "neutral"
    np.testing.assert_allclose(mode.of("rod")[:2], 0.0, atol=1e-9)


def test_inverted_pendulum() -> None:
    m = Mechanism("inverted", gravity=(0.0, -G))
    rod = m.bar("rod", 0.8, mass=2.0)
    m.revolute("A", m.ground.origin, rod.start)
    m.start_near(rod=90)
    linear = m.linearise(m.equilibrium(nearest=True))
    assert linear.stability == "unstable"
    rate = math.sqrt(1.5 * G / 0.8)
    np.testing.assert_allclose(sorted(linear.eigenvalues.real), [-rate, rate], rtol=1e-9)


def test_double_pendulum_of_equal_points() -> None:
    """omega^2 = (2 -+ sqrt 2) g / l; the lower swings sqrt 2 times the upper, with it or against it."""
    m = Mechanism("double", gravity=(0.0, -G))
    upper, lower = bob(m, "upper", 0.5), bob(m, "lower", 0.5)
    m.revolute("A", m.ground.origin, upper.origin)
    m.revolute("B", upper.at(0.5, 0.0), lower.origin)
    m.start_near(upper=-80, lower=-100)
    slow, fast = m.modes()
    assert slow.omega == pytest.approx(math.sqrt((2 - math.sqrt(2)) * G / 0.5), rel=1e-8)
    assert fast.omega == pytest.approx(math.sqrt((2 + math.sqrt(2)) * G / 0.5), rel=1e-8)
    for mode, sign in ((slow, 1.0), (fast, -1.0)):
        assert mode.of("lower")[2] / mode.of("upper")[2] == pytest.approx(sign * math.sqrt(2), rel=1e-7)
        assert mode.of("lower")[0] / mode.of("upper")[2] == pytest.approx(0.5, rel=1e-7)


@pytest.mark.parametrize("damping", [0.0, 4.0, 39.0, 90.0])
def test_mass_spring_damper(damping: float) -> None:
    m = Mechanism("oscillator", gravity=(0.0, -G))
    block = m.body("block", 2.0, inertia=1.0)
    m.prismatic("guide", m.ground.at(0, 0, math.pi / 2), block.at(0, 0, math.pi / 2))
    m.spring("spring", m.ground.at(0, 1.0), block.origin, 200.0, damping=damping, free_length=0.5)
    m.start_near(block=(0.0, 0.2, 0.0))
    linear = m.linearise()
    place = linear.model.starts["block"].place
    assert place is not None
    assert place[1] == pytest.approx(0.5 - 2.0 * G / 200.0)
    wanted = np.roots([2.0, damping, 200.0])
    np.testing.assert_allclose(np.sort_complex(linear.eigenvalues), np.sort_complex(wanted), rtol=1e-7, atol=1e-9)
    assert linear.stability == ("stable" if damping else "neutral")
    assert linear.stiffness[0, 0] == pytest.approx(200.0)
    assert linear.damping[0, 0] == pytest.approx(damping, abs=1e-6)
    assert linear.mass[0, 0] == pytest.approx(2.0)
    if damping == 4.0:
        [mode] = linear.modes
        assert mode.omega == pytest.approx(10.0)
        assert mode.damping_ratio == pytest.approx(0.1)
        assert mode.damped_frequency == pytest.approx(10.0 * math.sqrt(0.99) / (2 * math.pi))
    if damping == 90.0:
        assert [mode.damping_ratio for mode in linear.modes] == [1.0, 1.0]


def hanging_chain(count: int) -> Mechanism:
    m = Mechanism("chain", gravity=(0.0, -G))
    before = m.ground.origin
    for k in range(count):
        link = m.bar(f"link {k}", 1.0 / count, mass=1.0 / count)
        m.revolute(f"pin {k}", before, link.start)
        m.start_near(**{f"link {k}": -90.0})
        before = link.end
    return m


def test_a_hanging_chain_swings_with_the_zeros_of_bessel() -> None:
    """omega_k = j_0k / 2 sqrt(g / L) for the continuous chain (Bernoulli); links come close to it."""
    frequencies = hanging_chain(24).linearise().frequencies
    wanted = jn_zeros(0, 3) / 2 * math.sqrt(G) / (2 * math.pi)
    np.testing.assert_allclose(frequencies[:3], wanted, rtol=1e-2)
    assert frequencies[0] == pytest.approx(wanted[0], rel=1e-4)


def test_a_cantilever_of_links_has_the_frequencies_of_the_beam() -> None:
    """(beta L)^2 sqrt(EI / (rho A L^4)), beta L = 1.8751, 4.6941; links with springs EI / h (Hencky)."""
    count, stiffness = 20, 3.0
    m = Mechanism("cantilever", gravity=None)
    before, body = m.ground.origin, m.ground
    for k in range(count):
        link = m.bar(f"link {k}", 1.0 / count, mass=1.0 / count)
        m.revolute(f"pin {k}", before, link.start)
        m.torsion_spring(f"bend {k}", body, link, stiffness * count * (2.0 if k == 0 else 1.0))
        m.start_near(**{f"link {k}": 0.0})
        before, body = link.end, link
    modes = m.modes()
    np.testing.assert_allclose(
        [mode.omega for mode in modes[:2]], np.array([1.87510, 4.69409]) ** 2 * math.sqrt(stiffness), rtol=1e-2
    )
    tip = [mode.of(f"link {count - 1}")[1] for mode in modes[:2]]
    assert np.abs(tip).min() > 0.5, "the free end moves most in both"


def test_a_pendulum_on_a_turning_arm() -> None:
    """Without gravity the centrifugal field pulls it out: omega = speed sqrt(R / l)."""
    m = Mechanism("governor", gravity=None)
    arm = m.bar("arm", 0.6, mass=1.0)
    weight = bob(m, "weight", 0.2)
    m.revolute("A", m.ground.origin, arm.start)
    m.revolute("B", arm.end, weight.origin)
    m.drive_angle("motor", arm, constant_rate(7.0, 0.4))
    m.start_near(arm=math.degrees(0.4), weight=math.degrees(0.4))
    m.start_moving(weight=7.0)
    linear = m.linearise("start")
    assert linear.coordinates == ("weight.theta",)
    assert linear.modes[0].omega == pytest.approx(7.0 * math.sqrt(0.6 / 0.2), rel=1e-8)
    sol = m.simulate(0.5)
    later = m.linearise(sol, t=0.5)
    assert later.modes[0].omega == pytest.approx(7.0 * math.sqrt(0.6 / 0.2), rel=1e-5)
    assert later.time == 0.5


def spring_four_bar() -> Mechanism:
    gravity = (0.0, -G)
    m = linkages.four_bar(0.8, 0.3, 0.9, 0.7, (20, 80), masses=(1.0, 0.5, 2.0), law=None, at=50, gravity=gravity)
    at = m.bodies["coupler"].at(0.4, 0.1)
    m.spring("spring", at, m.ground.at(0.9, 0.5), 300.0, damping=12.0, free_length=0.1)
    return m


def test_the_nonlinear_motion_near_an_equilibrium_follows_the_matrix() -> None:
    m = spring_four_bar()
    m.torque("push", m.bodies["rocker"], 0.0)
    rest = m.equilibrium()
    linear = m.linearise(rest, inputs=["push"])
    small, push = 1e-4, 1e-3
    moved = m.with_efforts(push=push)
    rest.start(moved)
    angles = {name: math.degrees(start.angle) for name, start in moved.starts.items()}
    angles["crank"] += math.degrees(small)
    moved.starts.clear()
    moved.start_near(**angles)
    sol = moved.simulate(0.6, steps=12, tolerance=1e-11)
    gap = sol.body("crank").theta - rest.body("crank").theta
    whole = np.zeros((3, 3))
    whole[:2, :2], whole[:2, 2] = linear.a, linear.b[:, 0]
    predicted = [(expm(whole * t) @ [small, 0.0, push])[0] for t in sol.t]
    np.testing.assert_allclose(gap, predicted, atol=3e-4 * small)


def test_the_nonlinear_motion_near_a_moving_state_follows_the_matrix() -> None:
    """Over a short time: differences of two neighbouring motions grow as A says."""
    m = spring_four_bar()
    m.start_moving(crank=6.0)
    linear = m.linearise("start")
    h, duration = 1e-5, 2e-4

    def after(angle: float, rate: float) -> np.ndarray:
        other = spring_four_bar()
        other.start_near(crank=50.0 + math.degrees(angle))
        other.start_moving(crank=6.0 + rate)
        end = other.simulate(duration, steps=1, tolerance=1e-12).body("crank")
        return np.array([end.theta[-1], end.omega[-1]])

    flow = np.stack([(after(h, 0) - after(-h, 0)) / (2 * h), (after(0, h) - after(0, -h)) / (2 * h)], axis=1)
    np.testing.assert_allclose(logm(flow) / duration, linear.a, rtol=1e-2, atol=1e-2)


def test_a_driver_as_input_keeps_its_effort() -> None:
    """A rod held level by a motor: B is one over its inertia, and gravity pulls neither up nor down."""
    m = Mechanism("held", gravity=(0.0, -G))
    rod = m.bar("rod", 1.0, mass=3.0)
    m.revolute("A", m.ground.origin, rod.start)
    m.drive_angle("motor", rod, harmonic(0.3, 2.0, 0.0, math.radians(30)))
    rest = m.equilibrium()
    assert rest.driver("motor").torque == pytest.approx(3.0 * G * 0.5 * math.cos(math.radians(30)))
    with pytest.raises(MobilityError, match="nothing can move"):
        m.linearise(rest)
    linear = m.linearise(rest, inputs=["motor"])
    assert linear.b[1, 0] == pytest.approx(1.0)
    assert linear.a[1, 0] == pytest.approx(1.5 * G * math.sin(math.radians(30)))
    assert linear.inputs == ("motor",)


def test_free_bodies_have_modes_at_zero() -> None:
    m = Mechanism("dumbbell", gravity=None)
    first, second = m.body("first", 1.0, inertia=0.1), m.body("second", 2.0, inertia=0.1)
    m.prismatic("guide", first.origin, second.origin)
    m.spring("spring", first.origin, second.origin, 50.0, free_length=1.0)
    m.start_near(first=(0.0, 0.0, 20.0), second=(1.1, 0.5, 20.0))
    modes = m.modes()
    assert [mode.omega for mode in modes[:3]] == [0.0, 0.0, 0.0]
    assert modes[3].omega == pytest.approx(math.sqrt(50.0 * (1.0 + 0.5)))


def test_a_singular_pose_is_refused() -> None:
    m = Mechanism("flat", gravity=None)
    left, deck, right = m.bar("left", 1.0, mass=1.0), m.bar("deck", 2.0, mass=1.0), m.bar("right", 1.0, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), left.start)
    m.revolute("B", left.end, deck.start)
    m.revolute("C", deck.end, right.end)
    m.revolute("D", m.ground.at(2, 0), right.start)
    m.start_near(left=0, deck=0, right=0)
    with pytest.raises(SingularPoseError, match=r"flat: the .*pose at t = 0 s is singular"):
        m.linearise("start")


def test_wrong_arguments_are_refused() -> None:
    m = spring_four_bar()
    with pytest.raises(ModelError, match="no driver or force 'motor'; there is: spring"):
        m.linearise(inputs=["motor"])
    m.bushing("rubber", m.ground.at(0.8, 0), m.bodies["rocker"].start, (1.0, 1.0, 1.0))
    with pytest.raises(ModelError, match=r"'rubber' \(bushing\) has no single direction"):
        m.linearise(inputs=["rubber"])
    with pytest.raises(ModelError, match="linearise: there is no state 'rest'"):
        m.linearise("rest")
    with pytest.raises(ModelError, match="say at which time"):
        m.linearise(m.simulate(0.1, steps=2))
    with pytest.raises(ModelError, match="not of this mechanism"):
        m.linearise(spring_four_bar().equilibrium())
    with pytest.raises(ModelError, match="no body 'arm'"):
        m.modes()[0].of("arm")


def test_a_linearisation_prints_its_modes() -> None:
    text = str(spring_four_bar().linearise())
    assert "four_bar: 1 coordinates (crank.theta), stable" in text
    assert "Hz" in text
    assert "damping ratio" in text


def test_motions_without_mass_are_refused() -> None:
    m = Mechanism("light")
    rod = m.bar("rod", 1.0)
    m.revolute("A", m.ground.origin, rod.start)
    with pytest.raises(MobilityError, match="light: 'rod' has neither mass nor inertia, and can move in 1 way"):
        m.linearise("start")
    second = m.bar("second", 1.0)
    m.revolute("B", rod.end, second.start)
    bob = m.body("bob", 1.0)
    m.revolute("C", second.end, bob.origin)
    m.start_near(rod=-90, second=-90)
    with pytest.raises(MobilityError, match="light: 'rod' and 'second' have neither mass nor inertia"):
        m.linearise("start")
