"""Mechanisms of mubosym's examples 4, 5, 10 and 11, a spherical pendulum and Foucault's, against exact ends.

The exact ends come from two formulations that agree to 1e-10; the ends that mubosym's tests store are those of odeint
at 1e-5. Source: mubosym (https://github.com/DocBO/mubosym, MIT), exa_4, exa_5, exa_10, exa_11.
"""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mbsd.spatial import Body, Mechanism, constant_rate
from mbsd.spatial.model.rotation import euler_parameters
from tests.spatial.machines import about

G = 9.81


def x(angle: float) -> np.ndarray:
    return about((1, 0, 0), angle)


def y(angle: float) -> np.ndarray:
    return about((0, 1, 0), angle)


def z(angle: float) -> np.ndarray:
    return about((0, 0, 1), angle)


def test_three_skew_rods() -> None:
    """exa_4: R_k = R_(k-1) Ry(q_k) Rx(-pi / 4), com_k = com_(k-1) + 2 y_k, at q = u = 1; chaotic after 15 s."""
    m = Mechanism("three rods", gravity=(0, -G, 0))
    before, place, rotation = m.ground, np.array([0, 0, -math.pi / 4]), np.eye(3)
    for k in range(3):
        axis = rotation[:, 1]
        rotation = rotation @ y(1.0) @ x(-math.pi / 4)
        com = place + 2.0 * rotation[:, 1]
        rod = m.body(f"rod {k}", 1.0, inertia=(1, 1, 1), at=com, orientation=euler_parameters(rotation))
        m.revolute(f"q{k + 1}", before, rod, at=place, axis=axis)
        before, place = rod, com
    m.start_moving({f"q{k}": 1.0 for k in (1, 2, 3)})
    exact = {
        1: (3.1657820531937997, -0.9640423100918567, 2.2081507699197633),
        2: (3.6264594405851933, 1.523935156678696, -1.2756832047048943),
        5: (8.325766609066317, -0.6741969110452455, 0.3885512154546321),
        10: (14.317387378114942, -0.20029149035187932, 1.321563310689326),
    }
    sol = m.simulate(duration=10.0, steps=2000, tolerance=1e-12)
    for second, wanted in exact.items():
        reached = [1.0 + sol.joint(f"q{k}").turn[200 * second] for k in (1, 2, 3)]
        assert reached == pytest.approx(wanted, abs=1e-7 if second == 10 else 1e-8)


def test_a_pendulum_under_a_turning_mount() -> None:
    """exa_5: a mount turns about y at 5.5 rad/s, a drag of .5 at both centres of mass; at 30 s."""
    m = Mechanism("turning mount", gravity=(0, -G, 0))
    hinge = np.array([1.0, 1.5, 0.0])
    mount = m.body("mount", 1.0, com=hinge, inertia=(1, 1, 1))
    bob = m.body("bob", 1.0, com=(1.0, 0.0, 0.0), inertia=(1, 1, 1))
    m.revolute("mast", m.ground, mount, at=(0, 1.5, 0), axis=(0, 1, 0))
    m.revolute("hinge", mount, bob, at=hinge, axis=(0, 0, 1))
    m.drive_turn("motor", "mast", constant_rate(5.5))
    m.drag("air 1", mount, 0.5)
    m.drag("air 2", bob, 0.5)
    sol = m.simulate(times=[0.0, 30.0], tolerance=1e-11)
    reached = sol.joint("hinge").turn[-1], sol.joint("hinge").turn_rate[-1]
    assert reached == pytest.approx((1.4453089814742373, 0.0285468150738544), abs=1e-8)


def test_rods_with_torsion_springs() -> None:
    """exa_10: rods with torsion springs and drag, one of them welded; at 30 s."""
    m = Mechanism("torsion", gravity=(0, -G, 0))
    q = math.pi / 3

    def rod(name: str, rotation: np.ndarray, com: np.ndarray) -> Body:
        return m.body(name, 1.0, inertia=(10, 10, 10), at=com, orientation=euler_parameters(rotation))

    first, second = z(q), z(q) @ y(math.pi / 2) @ z(q)
    fourth = second @ y(q)
    origin = np.array([0.0, 0.0, 1.0])
    middle = origin - second[:, 1]
    end = middle + 2.0 * second[:, 2]
    rods = [
        rod("rod 1", first, origin), rod("rod 2", second, middle), rod("rod 3", second, end),
        rod("rod 4", fourth, end - 0.5 * fourth[:, 1]),
    ]  # fmt: skip
    m.revolute("q1", m.ground, rods[0], at=origin, axis=(0, 0, 1))
    m.revolute("q2", rods[0], rods[1], at=origin, axis=second[:, 2])
    m.fixed("weld", rods[1], rods[2], at=middle)
    m.revolute("q4", rods[2], rods[3], at=end, axis=second[:, 1])
    for name, stiffness, rest in (("q1", 800.0, math.pi), ("q2", 800.0, 0.0), ("q4", 100.0, 0.0)):
        m.torsion_spring(f"twist of {name}", name, stiffness=stiffness, free=rest - q)
    for part in rods:
        m.drag(f"air of {part.name}", part, 5.0)
    m.start_moving({"q1": 1.0, "q2": 1.0, "q4": 1.0})
    sol = m.simulate(times=[0.0, 30.0], tolerance=1e-10)
    exact = (3.192776601205436, -7.400147336733554e-05, 0.36051603645291763,
             -8.209002975249025e-06, 0.0004951839236792833, 1.6213192674492343)  # fmt: skip
    reached = [q + sol.joint(name).turn[-1] for name in ("q1", "q2", "q4")]
    reached += [sol.joint(name).turn_rate[-1] for name in ("q1", "q2", "q4")]
    turns = np.round((np.array(reached[:3]) - exact[:3]) / (2 * math.pi))
    assert np.array(reached[:3]) - 2 * math.pi * turns == pytest.approx(exact[:3], abs=1e-7)
    assert reached[3:] == pytest.approx(exact[3:], abs=1e-7)


def test_a_gyroscope_on_an_arm() -> None:
    """exa_11: a ball joint by angles (x, y, z), an arm of 2 m, a wheel of 50 kg m^2 that spins at 100 rad/s; 15 s."""
    m = Mechanism("gyroscope", gravity=None)
    ball = m.body("ball", 1.0, inertia=(1, 1, 1))
    arm = m.body("arm", 10.0, com=(2, 0, 0), inertia=(1, 1, 1))
    wheel = m.body("wheel", 1.0, com=(2, 0, 0), inertia=(50, 50, 50))
    m.spherical("pivot", m.ground, ball, at=(0, 0, 0))
    m.fixed("weld", ball, arm, at=(2, 0, 0))
    m.revolute("shaft", arm, wheel, at=(2, 0, 0), axis=(1, 0, 0))
    m.user_force("weight of the arm", lambda t, q, v: (0, -98.1, 0, 0, 0, 0), arm.marker((2, 0, 0)))
    m.start_moving({"ball": (0, 0, 0), "shaft": 100.0})
    sol = m.simulate(times=np.linspace(0, 15, 1501), tolerance=1e-11)
    r = sol.body("ball").rotation[-1]
    angles = math.atan2(-r[1, 2], r[2, 2]), math.asin(r[0, 2]), math.atan2(-r[0, 1], r[0, 0])
    exact = (0.0007981207597593941, 0.5879623216795032, -0.001599836891325535)
    assert angles == pytest.approx(exact, abs=1e-8)
    a, b = angles[:2]
    matrix = np.column_stack([[1, 0, 0], [0, math.cos(a), math.sin(a)], x(a) @ y(b) @ [0, 0, 1]])
    rates = np.linalg.solve(matrix, sol.body("ball").w[-1])
    assert rates == pytest.approx((0.00011583574026080643, 0.06024593399266357, -0.03323426149282123), abs=1e-7)
    assert sol.joint("shaft").turn_rate[-1] == pytest.approx(100.0, abs=1e-7)


def test_foucaults_pendulum_turns_with_the_earth() -> None:
    """Closed form: the swing turns by Omega sin(latitude) T a swing, 9.0162336e-4 rad at 48.85 degrees and 67 m.

    The earth is a body that turns; weight acts on the bob along the plumb line of the place, by a function.
    """
    latitude, earth, length, amplitude = math.radians(48.85), 7.292115e-5, 67.0, 0.05
    m = Mechanism("Foucault", gravity=None)
    pole = np.array([0.0, math.cos(latitude), math.sin(latitude)])  # x east, y north, z up
    ground = m.body("earth", 1.0, inertia=(1, 1, 1))
    m.revolute("axis", m.ground, ground, at=(0, 0, 0), axis=pole)
    m.drive_turn("day", "axis", constant_rate(earth))
    bob = m.body("bob", 1.0, com=(amplitude, 0, -length), inertia=(1, 1, 1))
    m.spherical("hook", ground, bob, at=(0, 0, 0))
    m.start_moving({"bob": tuple(earth * pole)})

    @numba.njit
    def weight(t, q, v):
        w, x, y, z = q[3], q[4], q[5], q[6]
        down = -2 * G * (x * z + w * y), -2 * G * (y * z - w * x), -G * (1 - 2 * (x * x + y * y))
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, down[0], down[1], down[2], 0.0, 0.0, 0.0

    m.user_force("weight", weight, ground, bob.marker((amplitude, 0, -length)))
    m.trace("bob", bob, at=(amplitude, 0, -length))
    period = 2 * math.pi * math.sqrt((length**2 + amplitude**2 + 1) / (G * math.hypot(length, amplitude)))
    sol = m.simulate(times=period * np.arange(4), tolerance=1e-11)
    local = np.einsum("tji,tj->ti", sol.body("earth").rotation, sol.point("bob").place)
    assert np.allclose(np.hypot(local[:, 0], local[:, 1]), amplitude, rtol=0, atol=1e-6)
    angle = np.arctan2(local[:, 1], local[:, 0])
    assert angle[3] / 3 == pytest.approx(-0.0009016233681831934, rel=2e-4)


def test_a_spherical_pendulum_keeps_energy_and_angular_momentum() -> None:
    """Against scipy: polar angle and azimuth of a symmetric pendulum, its spin about the rod kept."""
    m = Mechanism("spherical pendulum", gravity=(0, 0, -G))
    angle, rate, axial = 1.0, 3.0, 0.01
    bob = m.body("bob", 1.0, com=(math.sin(angle), 0, -math.cos(angle)), inertia=(axial, axial, axial))
    m.spherical("hook", m.ground, bob, at=(0, 0, 0))
    m.start_moving({"bob": (0, 0, rate)})
    m.trace("bob", bob, at=(math.sin(angle), 0, -math.cos(angle)))
    times = np.array([0.0, 1.0, 2.0, 5.0])
    place = m.simulate(times=times, tolerance=1e-11).point("bob").place
    whole = 1.0 + axial
    spin = axial * rate * math.cos(angle)
    turning = whole * rate * math.sin(angle) ** 2 + spin * math.cos(angle)

    def rates(t: float, y: np.ndarray) -> list[float]:
        theta, speed, _ = y
        sine, cosine = math.sin(theta), math.cos(theta)
        azimuth = (turning - spin * cosine) / (whole * sine**2)
        return [speed, (whole * azimuth**2 * sine * cosine - spin * azimuth * sine - G * sine) / whole, azimuth]

    exact = solve_ivp(rates, (0, 5), [angle, 0.0, 0.0], t_eval=times, rtol=1e-12, atol=1e-13).y
    assert np.allclose(np.arccos(-place[:, 2]), exact[0], rtol=0, atol=1e-7)
    assert np.allclose(np.exp(1j * np.arctan2(place[:, 1], place[:, 0])), np.exp(1j * exact[2]), rtol=0, atol=1e-7)
