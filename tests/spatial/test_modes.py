"""Equilibrium, linearisation and modes in space against closed forms, and the benchmark bicycle."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.base.errors import MobilityError, ModelError, SimulationError
from mbsd.spatial import Mechanism, polynomial
from tests.spatial import machines

G = 9.81


def bicycle(speed: float) -> Mechanism:
    """Return the benchmark bicycle, z down, that goes straight on along x."""
    m = Mechanism("bicycle", gravity=(0, 0, G))
    rear, front = (0, 0, -0.3), (1.02, 0, -0.35)
    tilt = 0.3141592653589793
    frame = m.body("frame", 85.0, com=(0.3, 0, -0.9), inertia=(9.2, 11.0, 2.8, 0.0, 2.4, 0.0))
    fork = m.body("fork", 4.0, com=(0.9, 0, -0.7), inertia=(0.05892, 0.06, 0.00708, 0.0, -0.00756, 0.0))
    wheels = (
        m.body("rear", 2.0, com=rear, inertia=(0.0603, 0.12, 0.0603)),
        m.body("front", 3.0, com=front, inertia=(0.1405, 0.28, 0.1405)),
    )
    m.revolute("rear axle", frame, wheels[0], at=rear, axis=(0, 1, 0))
    m.revolute("front axle", fork, wheels[1], at=front, axis=(0, 1, 0))
    m.revolute("head", frame, fork, at=(1.10, 0, 0), axis=(math.sin(tilt), 0, math.cos(tilt)))
    for wheel, centre, radius in ((wheels[0], rear, 0.3), (wheels[1], front, 0.35)):
        m.rolling(
            f"{wheel.name} tyre",
            m.ground,
            wheel,
            at=(0, 0, 0),
            normal=(0, 0, -1),
            centre=centre,
            axis=(0, 1, 0),
            ring=radius,
        )
    m.start_moving(
        {"frame": (0, 0, 0), "fork": (0, 0, 0), "rear": (0, -speed / 0.3, 0), "front": (0, -speed / 0.35, 0)}
    )
    return m


@pytest.mark.parametrize(
    ("speed", "wanted"),
    [
        (0.0, [-5.530943717654, -3.131643247907, 3.131643247907, 5.530943717654]),
        (
            5.0,
            [-14.078389692798, -0.775341882196 + 4.464867713788j, -0.775341882196 - 4.464867713788j, -0.322866429004],
        ),
        (8.0, [-20.279408943945, -2.693486835811 + 8.460379713969j, -2.693486835811 - 8.460379713969j, 0.143278797657]),
    ],
)
def test_a_bicycle_weaves_and_capsizes(speed: float, wanted: list[complex]) -> None:
    """Meijaard, Papadopoulos, Ruina, Schwab 2007, Proc. R. Soc. A 463, table 2."""
    m = bicycle(speed)
    assert m.mobility().dof == 3 + 4 - 4 + 0
    values = m.linearise("start").eigenvalues
    for value in wanted:
        assert np.abs(values - value).min() < 1e-8
    if speed:
        rest = np.array([v for v in values if min(abs(v - value) for value in wanted) > 1e-6])
        assert np.abs(rest).max() < 1e-3  # place, direction and speed are free


def test_a_bicycle_goes_straight_on() -> None:
    sol = bicycle(5.0).simulate(duration=1.0, steps=5, tolerance=1e-10)
    assert np.allclose(sol.body("frame").place[:, 0], 5.0 * sol.t, rtol=0, atol=1e-7)
    assert np.abs(sol.body("frame").place[:, 1]).max() < 1e-9


def test_a_bifilar_bar_hangs_level_and_swings_with_its_periods() -> None:
    """Closed forms: a bar on two parallel strings: g / l twice, and 12 g c^2 / (l L^2) about the vertical."""
    length, half, size = 0.8, 0.3, 1.0
    m = Mechanism("bar", gravity=(0, 0, -G))
    bar = m.body("bar", 2.0, inertia=(1e-3, 2.0 * size**2 / 12, 2.0 * size**2 / 12))
    for k, x in enumerate((-half, half)):
        m.distance(f"string {k}", m.ground, bar, start=(x, 0, length), end=(x, 0, 0))
    rest = m.equilibrium()
    assert np.allclose(rest.joint("string 0").magnitude, G, rtol=0, atol=1e-9)
    assert rest.body("bar").z[0] == pytest.approx(0.0, abs=1e-10)
    omegas = sorted(mode.omega for mode in m.modes())
    wanted = sorted([math.sqrt(G / length), math.sqrt(G / length), math.sqrt(12 * G * half**2 / (length * size**2))])
    close = [min(abs(omega - want) for omega in omegas) for want in wanted]
    assert max(close) < 1e-8
    assert any(mode.omega < 1e-6 for mode in m.modes())  # it turns about its own axis


def test_a_box_on_springs_has_the_frequencies_of_its_stiffness() -> None:
    """Six springs by a bushing: eigenvalues of M^-1 K, damping ratios of a modal damping."""
    m = Mechanism("box", gravity=None)
    moments = np.array([0.3, 0.4, 0.5])
    box = m.body("box", 2.0, inertia=moments)
    stiffness = np.array([200.0, 300.0, 450.0, 30.0, 50.0, 80.0])
    m.bushing("mount", m.ground, box, stiffness, 0.01 * stiffness, at=(0, 0, 0), axis=(0, 0, 1))
    modes = m.modes()
    wanted = np.sqrt(stiffness / np.concatenate([np.full(3, 2.0), moments]))
    axes = m.forces["mount"].i.axes
    assert np.allclose(np.abs(axes) @ np.abs(axes).T, np.eye(3))
    order = np.abs(axes) @ np.arange(3)
    turned = np.concatenate([stiffness[:3][np.argsort(order)], stiffness[3:][np.argsort(order)]])
    wanted = np.sort(np.sqrt(turned / np.concatenate([np.full(3, 2.0), moments])))
    assert np.allclose([mode.omega for mode in modes], wanted, rtol=1e-9)
    assert np.allclose([mode.damping_ratio for mode in modes], 0.005 * wanted, rtol=1e-7)


def test_free_rigid_motions_are_recognised() -> None:
    """Two masses on a spring in space: five rigid motions and more, one frequency sqrt(k / mu)."""
    m = Mechanism("pair", gravity=None)
    a = m.ball("a", (0, 0, 0), radius=0.1, mass=1.0)
    b = m.ball("b", (1, 0, 0), radius=0.1, mass=3.0)
    m.spring("spring", a, b, start=(0, 0, 0), end=(1, 0, 0), stiffness=12.0, damping=0.1)
    line = m.linearise()
    assert line.rigid == 11
    modes = line.modes
    assert [mode.omega for mode in modes[:11]] == [0.0] * 11
    assert modes[11].omega == pytest.approx(4.0, rel=1e-9)
    assert modes[11].of("a")[0] / modes[11].of("b")[0] == pytest.approx(-3.0, rel=1e-8)


def test_a_chain_hangs_down_from_any_start() -> None:
    m = Mechanism("chain", gravity=(0, 0, -G))
    before, place = m.ground, np.zeros(3)
    for k in range(3):
        end = place + 0.5 * np.array([math.cos(k), math.sin(k), 0.2])
        rod = m.rod(f"rod {k}", place, end, mass=1.0, radius=0.02)
        m.universal(f"joint {k}", before, rod, at=place, first=(0, 0, 1), second=np.cross(end - place, (0, 0, 1)))
        before, place = rod, end
    m.trace("tip", before, at=place)
    rest = m.equilibrium()
    tip = rest.solution.point("tip").place[0]
    assert rest.stiffness[0] == pytest.approx(0.0, abs=1e-9)  # all turns about the vertical without resistance
    assert rest.stiffness[1] > 1.0
    assert tip[2] == pytest.approx(-3 * 0.5 * math.sqrt(1.04), abs=1e-9)
    assert rest.joint("joint 0").force[0] == pytest.approx([0, 0, 3 * G], abs=1e-9)


def test_a_pendulum_stands_on_its_head_where_that_is_nearest() -> None:
    m = Mechanism("pendulum", gravity=(0, 0, -G))
    rod = m.rod("rod", (0, 0, 0), (0.1, 0, 1), mass=1.0, radius=0.02)
    m.revolute("hinge", m.ground, rod, at=(0, 0, 0), axis=(0, 1, 0))
    up, down = m.equilibrium(nearest=True), m.equilibrium()
    assert not up.stable
    assert down.stable
    assert up.joint("hinge").turn[0] == pytest.approx(-math.atan(0.1), abs=1e-9)
    assert down.stiffness[0] == pytest.approx(-up.stiffness[0], rel=1e-6)
    assert abs(down.joint("hinge").turn[0] - up.joint("hinge").turn[0]) == pytest.approx(math.pi, abs=1e-9)
    growing = m.linearise(up).eigenvalues
    whole = (3 * 0.02**2 + 1.01) / 12 + 1.01 / 4
    assert growing.real.max() == pytest.approx(math.sqrt(G * math.sqrt(1.01) / 2 / whole), rel=1e-8)


def test_drivers_and_springs_balance() -> None:
    """A lever that a driver holds at 30 degrees pulls by a spring at a slide: statics by hand."""
    m = Mechanism("lever", gravity=None)
    lever = m.rod("lever", (0, 0, 0), (1, 0, 0), mass=1.0, radius=0.02)
    cart = m.body("cart", 1.0, com=(3, 0, 0), inertia=(1, 1, 1))
    m.revolute("hinge", m.ground, lever, at=(0, 0, 0), axis=(0, 0, 1))
    m.prismatic("rail", m.ground, cart, at=(3, 0, 0), axis=(1, 0, 0))
    m.drive_turn("hand", "hinge", polynomial(math.radians(30), 5.0))
    m.spring("rope", lever, cart, start=(1, 0, 0), end=(3, 0, 0), stiffness=100.0, length=1.0)
    m.spring("wall", cart, m.ground, start=(3, 0, 0), end=(5, 0, 0), stiffness=50.0, length=1.0)
    rest = m.equilibrium()
    x = rest.body("cart").x[0] + 3.0
    way = np.array([x - math.cos(math.radians(30)), -0.5])
    pull = 100.0 * (np.linalg.norm(way) - 1.0) * way / np.linalg.norm(way)
    assert pull[0] == pytest.approx(50.0 * (5.0 - x - 1.0), abs=1e-8)
    torque = math.cos(math.radians(30)) * pull[1] - 0.5 * pull[0]
    assert rest.driver("hand").torque[0] == pytest.approx(-torque, abs=1e-8)


def test_redundant_loops_balance_too() -> None:
    m = machines.bricard()
    m.gravity = (0.0, -G, 0.0)
    rest = m.equilibrium()
    assert rest.stable
    weight = sum(body.mass for body in m.bodies.values()) * G
    total = rest.joint("hinge 0").force[0] - rest.joint("hinge 5").force[0]
    assert total == pytest.approx([0.0, weight, 0.0], abs=1e-7)


def test_what_has_no_equilibrium_is_refused() -> None:
    m = Mechanism("stone", gravity=(0, 0, -G))
    m.ball("stone", (0, 0, 0), radius=0.1, mass=1.0)
    with pytest.raises(SimulationError, match="no pose balances near the start"):
        m.equilibrium()
    driven = machines.hooke_joint(0.3)
    with pytest.raises(MobilityError, match="nothing can move"):
        driven.modes()
    with pytest.raises(ModelError, match="no state to linearise at 'strat', did you mean 'start'"):
        m.linearise("strat")
