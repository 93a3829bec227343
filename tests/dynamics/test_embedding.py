"""Independent against reference coordinates: every group, drivers beside freedoms, forces, singular poses."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, constant_rate, harmonic
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.reference.multipliers import fill_multipliers
from mbsd.dynamics.runs import motion
from mbsd.dynamics.runs.embedding import embed, embedded_at_start
from mbsd.dynamics.runs.motion import integrate
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.simulate import integrator_named
from mbsd.kinematics.groups.groups import KIND
from mbsd.kinematics.groups.tables import NAMES
from mbsd.results.solution import Solution
from tests.dynamics.test_simulate import n_four_bar
from tools.models.assur_models import MODELS
from tools.models.linkages import four_bar

PAIRS = ("q", "v", "a")


def both(m: Mechanism, duration: float = 0.5, **options) -> tuple[Solution, Solution]:
    """The same simulation in independent and in reference coordinates."""
    options = {"steps": 40, "tolerance": 1e-10, **options}
    independent = m.simulate(duration, formulation="independent", **options)
    reference = m.simulate(duration, formulation="reference", **options)
    assert independent.stats.independent
    assert not reference.stats.independent
    return independent, reference


def agree(computed: Solution, reference: Solution, close: float = 1e-6) -> None:
    """Motion, multipliers, reactions and work are the same, and fulfil all equations."""
    for name in PAIRS:
        a, b = getattr(computed, name), getattr(reference, name)
        np.testing.assert_allclose(a, b, atol=close * max(1.0, np.abs(b).max()), err_msg=name)
    np.testing.assert_allclose(computed.wrench, reference.wrench, atol=close * max(1.0, np.abs(reference.wrench).max()))
    assert computed.work is not None
    assert reference.work is not None
    np.testing.assert_allclose(computed.work, reference.work, atol=close * max(1.0, np.abs(reference.work).max()))
    assert computed.stats.position_residual < 1e-11
    assert computed.stats.velocity_residual < 1e-9
    assert computed.stats.acceleration_residual < 1e-6


def freed(name: str) -> Mechanism:
    """A mechanism of the closed forms without its drivers."""
    m = MODELS[name]()
    m.drivers.clear()
    m.gravity = (0.5, -9.81)
    return m


def with_pendulum(name: str) -> Mechanism:
    """The same with its drivers, and a pendulum on its last body."""
    m = MODELS[name]()
    m.gravity = (0.5, -9.81)
    last = list(m.bodies.values())[-1]
    bob = m.bar("bob", 0.2, 0.5)
    m.revolute("hang", last.at(0.05, 0.02), bob.start)
    m.start_near(bob=-60)
    return m


# -- every group ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", MODELS)
def test_freed_mechanisms(name: str) -> None:
    m = freed(name)
    ready = prepare_dynamics(m, 0.0, 0.4)
    if embedded_at_start(ready) is None:
        assert "driven" in name or "carried" in name, "only what its drivers hold together has no plan of its own"
        return
    agree(*both(m, 0.4))


@pytest.mark.parametrize("name", MODELS)
def test_drivers_beside_a_freedom(name: str) -> None:
    agree(*both(with_pendulum(name), 0.4))


def test_every_group_is_tried() -> None:
    seen = set()
    for name in MODELS:
        for m in (freed(name), with_pendulum(name)):
            made = embedded_at_start(prepare_dynamics(m, 0.0, 1.0))
            if made is not None:
                seen |= {NAMES[kind] for kind in made.arrays.group[:, KIND]}
    assert seen == set(NAMES)


# -- several coordinates ----------------------------------------------------------------------------------------------


def chain(lengths: list[float], slide: bool = False) -> Mechanism:
    """Bars in a row, hung from ground or from a cart."""
    m = Mechanism("chain")
    at = m.ground.at(0, 0)
    if slide:
        cart = m.body("cart", 2.0, com=(0.05, 0.02), inertia=0.1)
        m.prismatic("rail", m.ground.at(0.1, 0.2, 0.3), cart.at(0.02, 0.01, 0.1))
        m.start_moving(cart=(0.5 * math.cos(0.3), 0.5 * math.sin(0.3), 0.0))
        at = cart.at(0.1, -0.1)
    for k, length in enumerate(lengths):
        bar = m.bar(f"bar{k}", length, 1.0 + k, com=(0.4 * length, 0.1 * length))
        m.revolute(f"pin{k}", at, bar.start)
        m.start_near(**{bar.name: -80 + 35 * k})
        at = bar.end
    return m


@pytest.mark.parametrize("slide", [False, True])
@given(lengths=st.lists(st.floats(0.2, 1.0), min_size=1, max_size=4))
@settings(max_examples=5)
def test_open_chains(slide: bool, lengths: list[float]) -> None:
    agree(*both(chain(lengths, slide), 0.5), close=1e-5)


def test_long_chains_stay_in_reference_coordinates() -> None:
    sol = chain([0.3] * 8).simulate(0.1, steps=4)
    assert not sol.stats.independent


def test_angles_count_their_turns() -> None:
    """A flywheel that a rocking lever's linkage carries round and round."""
    m = Mechanism("turns")
    wheel = m.body("wheel", 1.0, inertia=0.5)
    m.revolute("O", m.ground.at(0, 0), wheel.origin)
    m.start_moving(wheel=50.0)
    bar = m.bar("bar", 1.0, 0.2)
    m.revolute("A", wheel.at(0.2, 0), bar.start)
    m.pin_in_slot("rail", m.ground.at(0, 0), bar.end)
    m.start_near(bar=0)
    sol = m.simulate(2.0, steps=50)
    assert sol.stats.independent
    theta = sol.body("wheel").theta
    assert theta[-1] > 40.0
    assert (np.diff(theta) > 0).all()


# -- forces -----------------------------------------------------------------------------------------------------------


def _loaded() -> Mechanism:
    m = freed("RRR")
    rocker, coupler, crank = (m.bodies[n] for n in ("rocker", "coupler", "crank"))
    m.spring("spring", m.ground.at(0.1, 0.5), coupler.at(0.1, 0.1), 300.0, damping=2.0, free_length=0.3)
    m.torsion_spring("clock", m.ground, rocker, 4.0, damping=0.05, free_angle=1.0)
    m.torque("push", crank, 0.4)
    m.drag("air", rocker.end, 0.8)
    m.user_force("wind", lambda t, q, v: [0.3 * math.sin(9 * t), -0.2 * v[1], 0.01 * q[2]], rocker)
    return m


def test_forces_of_all_sorts() -> None:
    agree(*both(_loaded(), 0.6), close=1e-5)


def _light() -> Mechanism:
    return four_bar(0.4, 0.1, 0.38, 0.3, (45.0, 90.0), masses=(1.0, None, 1.0), law=None, at=10.0)


def test_bodies_without_mass() -> None:
    agree(*both(_light(), 0.5), close=1e-5)


@pytest.mark.parametrize("make", [_loaded, _light, lambda: with_pendulum("RRP"), lambda: with_pendulum("rod driven")])
def test_multipliers_of_outputs_are_those_of_reference_coordinates_to_the_last_digit(make) -> None:
    """The same pose and velocities, evaluated both ways."""
    m = make()
    ready = prepare_dynamics(m, 0.0, 0.4)
    method = integrator_named(m.name, "dop853")
    _, out = integrate(ready, method, np.linspace(0.0, 0.4, 9), 1e-8, 0.05, formulation="independent")
    fill_multipliers(ready.packed, ready.dynamics, out.t, out.y, out.lam, out.margin)
    scratch, lam = Run(ready, method, 1e-8, 0.05, 0.4, {}).scratch, np.zeros_like(out.lam[0])
    for k, t in enumerate(out.t):
        derivative(ready.dynamics, scratch, float(t), out.y[k], np.zeros_like(out.y[k]), lam)
        np.testing.assert_array_equal(out.lam[k], lam)
        assert out.margin[k] == scratch.report[0]


# -- poor and singular poses ------------------------------------------------------------------------------------------


def double_rocker() -> Mechanism:
    """Neither lever turns round: both pass poses in which they tell the other's place badly."""
    m = four_bar(0.4, 0.3, 0.2, 0.32, (5.0, 110.0), masses=(1.0, 0.5, 1.0), law=None, at=70.0)
    m.start_moving(crank=8.0)
    return m


def test_coordinates_change_where_others_are_better(monkeypatch: pytest.MonkeyPatch) -> None:
    taken = []
    original = motion.IndependentSteps._enter

    def watched(self, made, *rest) -> None:
        taken.append(made.coordinates[0].body)
        original(self, made, *rest)

    monkeypatch.setattr(motion.IndependentSteps, "_enter", watched)
    independent, reference = both(double_rocker(), 2.0, tolerance=1e-11)
    agree(independent, reference, close=1e-5)
    assert len(set(taken)) > 1, "no other coordinate was taken"
    assert np.ptp(independent.energy.total) < 1e-6


@pytest.mark.parametrize("loops", [1, 5])
def test_change_points_are_passed_on_the_smooth_branch(loops: int) -> None:
    sol = n_four_bar(loops).simulate(6.0, steps=333, tolerance=1e-9, formulation="independent")
    for k in range(1, loops + 1):
        np.testing.assert_allclose(sol.body(f"coupler {k}").theta, 0.0, atol=1e-6)
        np.testing.assert_allclose(sol.body(f"rod {k}").theta, sol.body("rod 0").theta, atol=1e-6)
    assert abs(sol.body("rod 0").theta[-1]) > 2 * math.pi
    assert np.ptp(sol.energy.total) < 1e-5


def test_an_output_at_a_change_point_itself() -> None:
    """The very time of the flat pose is an output, then the end."""
    m = n_four_bar(1)
    sol = m.simulate(2.0, steps=2000, tolerance=1e-11)
    k = int(np.argmax(sol.body("rod 0").theta < 0))
    t, theta, omega, here = sol.t[k], sol.body("rod 0").theta[k], sol.body("rod 0").omega[k], sol
    for _ in range(3):
        t -= theta / omega
        here = m.simulate(times=[0.0, t, 2.0], tolerance=1e-11, formulation="independent")
        theta, omega = here.body("rod 0").theta[1], here.body("rod 0").omega[1]
    assert abs(theta) < 1e-7
    assert here.stats.independent
    assert np.isfinite(here.q).all()
    assert np.isfinite(here.v).all()
    np.testing.assert_allclose(here.body("coupler 1").theta, 0.0, atol=1e-6)
    np.testing.assert_allclose(here.q[-1], sol.q[-1], atol=1e-6)
    end = m.simulate(times=[0.0, t], tolerance=1e-11, formulation="independent")
    for name in ("q", "v"):
        np.testing.assert_allclose(getattr(end, name)[-1], getattr(here, name)[1], atol=1e-8)


# -- what is refused --------------------------------------------------------------------------------------------------


def test_what_must_stay_in_reference_coordinates_says_why() -> None:
    m = double_rocker()
    with pytest.raises(ModelError, match="no formulation 'fast'"):
        m.simulate(0.1, formulation="fast")
    with pytest.raises(ModelError, match="'rk4' works in reference"):
        m.simulate(0.1, method="rk4", formulation="independent")
    m.friction("rub", "A", 0.1, radius=0.01)
    with pytest.raises(ModelError, match="reactions"):
        m.simulate(0.1, formulation="independent")
    thrown = Mechanism("thrown")
    first, second = thrown.bar("first", 0.3, 1.0), thrown.bar("second", 0.3, 1.0)
    thrown.revolute("A", first.end, second.start)
    with pytest.raises(ModelError, match="fall apart"):
        thrown.simulate(0.1, formulation="independent")
    assert not thrown.simulate(0.1, steps=2).stats.independent


def test_no_choice_at_a_flat_pose() -> None:
    """All rods in one line: no coordinate tells the branch."""
    ready = prepare_dynamics(n_four_bar(1), 0.0, 1.0)
    q = ready.initial.q.copy()
    q[:] = [0, 0, 0, 0.5, 0, 0, 1.5, 0, 0, 1.5, 0, 0]  # ground, rod 0, rod 1, coupler 1
    assert embed(ready, q, np.zeros_like(q), 0.0) is None


def test_laws_of_time_with_rates() -> None:
    """A driven base that carries a free arm: convective terms of the law."""
    m = Mechanism("shaker")
    table, arm = m.body("table", 1.0, inertia=0.1), m.bar("arm", 0.4, 0.7)
    m.prismatic("rail", m.ground.at(0, 0, 0.2), table.origin)
    m.drive_coordinate("shake", m.ground.at(0, 0, 0.2), table.origin, harmonic(0.1, 12.0))
    m.revolute("pin", table.at(0.1, 0.0), arm.start)
    m.start_near(arm=-70)
    spun = m.bar("spun", 0.3, 0.4)
    m.revolute("tip", arm.end, spun.start)
    m.drive_relative_angle("wheel", arm, spun, constant_rate(15.0))
    agree(*both(m, 0.6), close=1e-5)
