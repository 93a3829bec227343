"""Every kind of force on random motions: power, action and reaction, potential; and closed forms of each kind."""

from __future__ import annotations

import importlib
import math
import pkgutil

import numpy as np
import pytest

import mbsd.model.forces
from mbsd import Mechanism, ModelError, curve, harmonic
from mbsd.arrays.friction_along import normals_along
from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.loads_along import loads_along
from mbsd.arrays.packing import Packed, pack
from mbsd.base.codes import POTENTIAL_TERMS, PUSH
from mbsd.equations.assembly import tabulate
from mbsd.equations.joint_friction import tabulate_friction
from mbsd.equations.loads import tabulate_loads
from mbsd.model.force import FORCE_KINDS, ForceKind
from mbsd.results.energy import potential_of


def all_kinds() -> list[ForceKind]:
    """Import every file of mbsd/model/forces."""
    for module in pkgutil.iter_modules(mbsd.model.forces.__path__):
        importlib.import_module(f"mbsd.model.forces.{module.name}")
    return list(FORCE_KINDS.values())


def example(kind: ForceKind, seed: int, to_ground: bool = False) -> tuple[Mechanism, Packed]:
    """One force of a kind between two bodies with centres of mass off their frames."""
    random = np.random.default_rng(seed)
    m = Mechanism("example")
    first = m.ground if to_ground else m.body("first", 1.0, list(random.normal(size=2)), 1.0)
    second = m.body("second", 1.0, list(random.normal(size=2)), 1.0)
    assert kind.example is not None
    kind.example(m, first.at(*random.normal(size=3)), second.at(*random.normal(size=3)))
    return m, pack(m)


def motion(packed: Packed, seed: int, count: int = 40) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A smooth random motion of all coordinates; ground rests."""
    random = np.random.default_rng(seed + 50)
    amplitude, phase = random.normal(size=(2, packed.coordinates))
    t = np.linspace(0.0, 1.0, count)
    q, v = np.zeros((2, count, packed.coordinates + 3))
    q[:, 3:] = amplitude * np.sin(2.0 * t[:, None] + phase)
    v[:, 3:] = 2.0 * amplitude * np.cos(2.0 * t[:, None] + phase)
    return t, q, v


def evaluate(packed: Packed, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(T, 3 nb) loads and (T,) their power; friction under the reactions of multipliers of 1, 2 ..."""
    loads, laws = pack_loads(packed), compiled_laws(packed, 0.0, 1.0)
    force, power = np.zeros_like(q), np.zeros(len(t))
    tabulate_loads(packed.system, loads, laws, t, q, v, packed.ws, force, power)
    if len(loads.rub):
        rows = len(packed.ws.phi)
        phi, gamma, compact = *np.zeros((2, len(t), rows)), np.zeros((len(t), rows, 6))
        tabulate(packed.system, packed.drives(t), q, v, packed.ws, phi, compact, gamma)
        normal = normals_along(packed, loads, q, compact, np.tile(1.0 + np.arange(rows), (len(t), 1)))
        tabulate_friction(packed.system, loads, q, v, normal, packed.ws, force, power)
    force[:, :3] = 0.0
    return force, power


KINDS = all_kinds()


def test_each_file_registers_its_kind() -> None:
    files = {module.name for module in pkgutil.iter_modules(mbsd.model.forces.__path__)} - {"kind"}
    assert files == {kind.name for kind in KINDS}


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_only_loads_from_outside_push(kind: ForceKind) -> None:
    m, _packed = example(kind, 0)
    [force] = m.forces.values()
    assert kind.outside or all(element.kind != PUSH for element in kind.elements(force))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_power_is_force_times_velocity(kind: ForceKind, seed: int) -> None:
    _m, packed = example(kind, seed)
    t, q, v = motion(packed, seed)
    force, power = evaluate(packed, t, q, v)
    assert np.abs(force[:, 3:]).max() > 0.0, "an example that does nothing proves nothing"
    np.testing.assert_allclose(power, (force * v)[:, 3:].sum(axis=1), rtol=1e-10, atol=1e-9 * np.abs(power).max())


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_pairs_act_and_react(kind: ForceKind, seed: int) -> None:
    m, packed = example(kind, seed)
    [force] = m.forces.values()
    t, q, v = motion(packed, seed)
    load = evaluate(packed, t, q, v)[0].reshape(len(t), -1, 3)
    if kind.outside:  # nothing feels the opposite
        acted = {force.j.body.name} | {one.j.body.name for one in kind.interactions(force, packed.masses)}
        others = [b for b, name in enumerate(packed.body_names) if name not in acted]
        assert not load[:, others].any()
        return
    place = q.reshape(len(t), -1, 3)
    moment = load[..., 2] + place[..., 0] * load[..., 1] - place[..., 1] * load[..., 0]
    size = np.abs(load).max()
    np.testing.assert_allclose(load[..., :2].sum(axis=1), 0.0, atol=1e-12 * size)
    np.testing.assert_allclose(moment.sum(axis=1), 0.0, atol=1e-11 * size)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_elastic_forces_are_the_slope_of_their_potential(kind: ForceKind, seed: int) -> None:
    m, packed = example(kind, seed)
    [force] = m.forces.values()
    t, q, v = motion(packed, seed, 7)
    elements = kind.elements(force)
    terms = {term.kind for element in elements for term in element.terms}
    potential = potential_of(packed, force, q)
    if not terms & set(POTENTIAL_TERMS) and not potential.any():
        assert kind.potential is None or kind.name == "rotating_frame", "a law of time has no potential"
        return
    load = loads_along(packed, pack_loads(packed), compiled_laws(packed, 0.0, 1.0), t, q, np.zeros_like(v))
    resting = _resting_part(packed, elements, q) if elements else np.zeros_like(q)
    for c in range(3, q.shape[1]):
        step = np.zeros(q.shape[1])
        step[c] = 1e-6
        slope = (potential_of(packed, force, q + step) - potential_of(packed, force, q - step)) / 2e-6
        np.testing.assert_allclose(load[:, c] - resting[:, c], -slope, rtol=2e-6, atol=2e-6 * np.abs(load).max())


def _resting_part(packed: Packed, elements, q: np.ndarray) -> np.ndarray:
    """Loads at rest that do not come from a potential: constants, and curves of rate at zero."""
    loads, laws = pack_loads(packed), compiled_laws(packed, 0.0, 1.0)
    elastic = np.isin(loads.term[:, 0], POTENTIAL_TERMS)
    loads.number[elastic, 0] = 0.0
    return loads_along(packed, loads, laws, np.zeros(len(q)), q, np.zeros_like(q))


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


def test_kepler_orbit_returns_after_its_period() -> None:
    m = Mechanism("orbit", gravity=None)
    planet = m.body("planet", 1.0, inertia=1.0)
    m.gravitation("pull", m.ground.at(0, 0), planet.origin, -4.0 * math.pi**2)
    m.start_near(planet=(0.5, 0.0, 0.0))
    m.start_moving(planet=(0.0, 2 * math.pi * math.sqrt(3.0), 0.0))
    view = m.simulate(1.0, steps=10, tolerance=1e-11).body("planet")
    np.testing.assert_allclose([view.x[5], view.y[5]], [-1.5, 0.0], atol=1e-7)
    np.testing.assert_allclose([view.x[-1], view.y[-1]], [0.5, 0.0], atol=1e-7)


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
        (lambda m, a, b: m.spring("s", a.origin, "b", 1.0), "needs two markers"),
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
