"""Every kind of force on random motions: power, action and reaction, potential; and closed forms of each kind."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, curve, harmonic
from mbsd.extend import CONSTANT, LINE, LINEAR, PUSH, Element, ForceKind, Marker, Term, add_force
from mbsd.model.force import FORCE_KINDS
from mbsd.testing import check_force, force_kinds


def test_each_kind_is_a_method() -> None:
    for kind in force_kinds():
        assert callable(getattr(Mechanism, kind.name)), kind.name


@pytest.mark.parametrize("kind", force_kinds(), ids=lambda kind: kind.name)
def test_power_reaction_and_potential(kind: ForceKind) -> None:
    check_force(kind)


def _spring(**more) -> ForceKind:
    """A spring of 120 N/m and no length, and what its kind says otherwise."""
    elements = more.pop("elements", lambda force: (Element(LINE, (Term(LINEAR, 120.0),)),))
    example = more.pop("example", lambda m, i, j: add_force(m, kind, "example", i, j, {}))
    kind = ForceKind("example", elements, example, **more)

    @kind.adds
    def add(m, name: str, i: Marker, j: Marker):
        return add_force(m, kind, name, i, j, {})

    return kind


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ({"outside": True}, "example: a load from outside on 'second' acts on 'first', too"),
        ({"elements": lambda force: (Element(PUSH, (Term(CONSTANT, 2.0),)),)}, "PUSH acts on one body alone"),
        ({"elements": lambda force: (Element(LINE, (Term(CONSTANT, 0.0),)),)}, "the example gives no load"),
        ({"potential": lambda force, masses, q: 0.1 * q[:, 3] ** 2}, r"loads against -dV/dq, x of 'first'"),
        ({"example": lambda m, i, j: None}, "its example must add one 'example' and no other force"),
    ],
)  # fmt: skip
def test_a_wrong_force_is_found(more: dict, says: str, monkeypatch: pytest.MonkeyPatch) -> None:
    kind = _spring(**more)
    monkeypatch.setitem(FORCE_KINDS, "example", kind)
    with pytest.raises(AssertionError, match=says):
        check_force(kind)


def test_a_right_force_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    kind = _spring()
    monkeypatch.setitem(FORCE_KINDS, "example", kind)
    check_force(kind)


def test_spring_mass_swings_with_the_root_of_stiffness_over_mass() -> None:
    m = Mechanism("swing", gravity=None)
    cart = m.body("cart", 2.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), cart.origin)
    m.spring("spring", m.ground.at(-1.0, 0), cart.origin, 200.0, free_length=1.0)
    m.start_near(cart=(0.3, 0.0, 0.0))
    sol = m.simulate(2.0, tolerance=1e-10)
    np.testing.assert_allclose(sol.body("cart").x, 0.3 * np.cos(10.0 * sol.t), atol=1e-8)
    assert np.ptp(sol.energy.total) < 1e-7


def test_damped_torsion_pendulum_decays_as_it_must() -> None:
    m = Mechanism("torsion", gravity=None)
    disc = m.body("disc", 1.0, inertia=0.5)
    m.revolute("axle", m.ground.at(0, 0), disc.origin)
    m.torsion_spring("spring", m.ground, disc, 8.0, damping=0.4)
    m.start_near(disc=30)
    sol = m.simulate(3.0, tolerance=1e-10)
    decay, rate = 0.4, math.sqrt(16.0 - 0.16)
    expected = math.radians(30) * np.exp(-decay * sol.t) * (np.cos(rate * sol.t) + decay / rate * np.sin(rate * sol.t))
    np.testing.assert_allclose(sol.body("disc").theta, expected, atol=1e-8)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-7


def test_constant_force_in_the_world_and_in_the_body() -> None:
    m = Mechanism("pushed", gravity=None)
    m.force("push", m.body("sled", 4.0, inertia=1.0).origin, 8.0, direction=math.pi / 2)
    assert m.simulate(3.0).body("sled").y[-1] == pytest.approx(9.0)
    turning = Mechanism("turning", gravity=None)
    top = turning.body("top", 1.0, inertia=1.0)
    turning.force("jet", top.origin, 1.0, frame=top)
    turning.start_moving(top=2.0)
    sol = turning.simulate(3.0, tolerance=1e-10)
    np.testing.assert_allclose(sol.body("top").vx, np.sin(2 * sol.t) / 2, atol=1e-8)
    np.testing.assert_allclose(sol.body("top").vy, (1 - np.cos(2 * sol.t)) / 2, atol=1e-8)


@pytest.mark.parametrize("law", [harmonic(3.0, 2.0), lambda t: 3.0 * math.sin(2.0 * t)])
def test_torque_by_a_law_of_time(law) -> None:
    m = Mechanism("shaken", gravity=None)
    disc = m.body("disc", 1.0, inertia=0.5)
    m.revolute("axle", m.ground.at(0, 0), disc.origin)
    m.torque("shaker", disc, law)
    sol = m.simulate(2.0, tolerance=1e-10)
    np.testing.assert_allclose(sol.body("disc").omega, 3.0 * (1 - np.cos(2.0 * sol.t)), atol=1e-7)


def test_gas_does_the_work_of_its_polytrope() -> None:
    m = Mechanism("gas", gravity=None)
    piston = m.body("piston", 0.5, inertia=1.0)
    m.prismatic("bore", m.ground.at(0, 0), piston.origin)
    m.gas("charge", m.ground.at(0, 0), piston.origin, 0.01, 2e6, at=0.02, clearance=0.01, exponent=1.3, outside=0.0)
    m.start_near(piston=(0.02, 0.0, 0.0))
    sol = m.simulate(0.004, tolerance=1e-10)
    x = sol.body("piston").x
    work = 0.01 * 2e6 * 0.03**1.3 / 0.3 * (0.03**-0.3 - (x + 0.01) ** -0.3)
    np.testing.assert_allclose(sol.energy.kinetic, work, rtol=1e-7, atol=1e-6)


def test_motor_runs_up_to_its_idle_speed() -> None:
    m = Mechanism("motor", gravity=None)
    rotor = m.body("rotor", 1.0, inertia=0.1)
    m.revolute("axle", m.ground.at(0, 0), rotor.origin)
    m.motor("motor", m.ground, rotor, curve([0.0, 100.0], [2.0, 0.0], kind="linear"))
    sol = m.simulate(4.0, tolerance=1e-9)
    np.testing.assert_allclose(sol.body("rotor").omega, 100.0 * (1 - np.exp(-0.2 * sol.t)), atol=1e-5)


def test_curve_of_length_is_a_hardening_spring() -> None:
    x = np.linspace(0.5, 1.5, 41)
    m = Mechanism("hardening", gravity=None)
    cart = m.body("cart", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), cart.origin)
    m.curve_of_length(
        "spring", m.ground.at(-1.0, 0), cart.origin, curve(x, -50 * (x - 1) - 400 * (x - 1) ** 3, "spline")
    )
    m.start_near(cart=(0.3, 0.0, 0.0))
    sol = m.simulate(2.0, tolerance=1e-10)
    gone = sol.body("cart").x
    exact = 25 * (0.09 - gone**2) + 100 * (0.0081 - gone**4)
    np.testing.assert_allclose(sol.energy.kinetic, exact, atol=1e-6)
    assert np.ptp(sol.energy.total) < 1e-6


def test_bushing_holds_a_load_in_both_directions() -> None:
    m = Mechanism("mount", gravity=(0.0, -10.0))
    block = m.body("block", 3.0, inertia=0.2)
    m.bushing("mount", m.ground.at(0, 0), block.origin, (500.0, 300.0, 40.0), damping=(60.0, 60.0, 4.0))
    m.force("side", block.origin, 25.0)
    m.torque("twist", block, 2.0)
    view = m.simulate(4.0).body("block")
    assert (view.x[-1], view.y[-1], view.theta[-1]) == pytest.approx((0.05, -0.1, 0.05), abs=1e-6)


def test_sweep_balances_springs_with_the_driver() -> None:
    m = Mechanism("door", gravity=None)
    door = m.bar("door", 1.0, mass=1.0)
    m.revolute("hinge", m.ground.at(0, 0), door.start)
    m.torsion_spring("closer", m.ground, door, 5.0)
    m.drive_angle("hand", door, harmonic(1.0, 1e-3))
    sol = m.sweep(1000.0, steps=20)
    np.testing.assert_allclose(sol.driver("hand").torque, 5.0 * sol.body("door").theta, atol=1e-5)
    assert sol.stats.power_residual < 1e-12


@pytest.mark.parametrize(
    ("add", "words"),
    [
        (lambda m, a, b: m.spring("s", a.origin, b.origin, -1.0), "stiffness is -1"),
        (lambda m, a, b: m.spring("s", a.origin, b.origin, math.nan), "finite"),
        (lambda m, a, b: m.spring("s", a.origin, a.origin, 1.0), "with itself"),
        (lambda m, a, b: m.spring("s", a.origin, "b", 1.0), "j is 'b'; it must be a marker"),
        (lambda m, a, b: m.force("s", a.origin, 1.0, direction=(0, 0)), "no direction"),
        (lambda m, a, b: m.bushing("s", a.origin, b.origin, (1.0, 2.0)), "give \\(x, y, turning\\)"),
        (lambda m, a, b: m.curve_of_length("s", a.origin, b.origin), "has no curve"),
        (lambda m, a, b: m.motor("s", a, b, lambda w: 1.0), "must be a curve"),
        (lambda m, a, b: m.gas("s", a.origin, b.origin, 1.0, 1.0, at=0.0), "must be positive"),
        (lambda m, a, b: curve([0, 0], [1, 2]), "x must rise"),
        (lambda m, a, b: curve([0, 1], [1, 2], "cubic"), "no kind 'cubic'"),
    ],
)
def test_wrong_forces_are_refused_when_built(add, words: str) -> None:
    m = Mechanism("refused")
    a, b = m.body("a", 1.0), m.body("b", 1.0)
    with pytest.raises(ModelError, match=words):
        add(m, a, b)
    assert not m.forces
