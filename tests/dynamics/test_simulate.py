"""Forward dynamics: closed forms, conserved quantities, massless links, redundant joints, consistent starts."""

from __future__ import annotations

import gc
import json
import math
from pathlib import Path

import numpy as np
import pytest
from numba.core.dispatcher import Dispatcher
from scipy.special import ellipk

from mbsd import AssemblyError, InitialConditionWarning, Mechanism, MobilityError, ModelError, constant_rate
from mbsd.base.running import Kept
from mbsd.compiling.jit import OFTEN
from mbsd.dynamics.prepare import prepare
from mbsd.dynamics.runs.motion import integrate
from mbsd.dynamics.simulate import integrator_named
from tools.models import linkages

A02 = json.loads((Path(__file__).parents[1] / "published" / "reference" / "iftomm_a02_n_four_bar_n2.json").read_text())[
    "expected"
][0]
G = 9.81


def pendulum(start: float = -90.0, inertia: float = 0.0) -> Mechanism:
    m = Mechanism("pendulum", gravity=(0.0, -G))
    bob = m.body("bob", 1.0, inertia=inertia)
    m.revolute("A", m.ground.at(0, 0), bob.at(0, 1.0))
    m.start_near(bob=start)
    return m


def n_four_bar(loops: int) -> Mechanism:
    m = Mechanism("four-bars", gravity=(0.0, -G))
    before = None
    for k in range(loops + 1):
        rod = m.bar(f"rod {k}", 1.0, mass=1.0)
        m.revolute(f"A{k}", m.ground.at(k, 0), rod.start)
        m.start_near(**{f"rod {k}": 90.0})
        if before is not None:
            coupler = m.bar(f"coupler {k}", 1.0, mass=1.0)
            m.start_near(**{f"coupler {k}": 0.0})
            m.revolute(f"B{k}", before.end, coupler.start)
            m.revolute(f"C{k}", coupler.end, rod.end)
        before = rod
    m.start_moving(**{"rod 0": -1.0})
    return m


def four_bar(coupler_mass: float) -> Mechanism:
    masses = (1.0, coupler_mass, 2.0)
    return linkages.four_bar(0.8, 0.3, 0.9, 0.7, (20.0, 80.0), masses=masses, law=None, at=50.0, gravity=(0.0, -G))


def test_pendulum_period_is_the_elliptic_integral() -> None:
    amplitude = math.radians(120)
    period = 4 * math.sqrt(1.0 / G) * ellipk(math.sin(amplitude / 2) ** 2)
    sol = pendulum(120.0).simulate(times=[0.0, period / 4, period / 2, period], tolerance=1e-10)
    np.testing.assert_allclose(sol.body("bob").theta, [amplitude, 0.0, -amplitude, amplitude], atol=1e-8)


def test_pendulum_reaction_is_weight_and_centripetal_force() -> None:
    sol = pendulum().simulate(2.0, tolerance=1e-10)
    bob = sol.body("bob")
    np.testing.assert_allclose(sol.joint("A").fx, bob.ax, atol=1e-9)
    np.testing.assert_allclose(sol.joint("A").fy, bob.ay + G, atol=1e-9)
    lowest = int(np.argmin(bob.y))
    assert sol.joint("A").magnitude[lowest] == pytest.approx(3 * G, rel=1e-3)


def test_n_four_bar_follows_the_exact_motion_through_its_singular_poses() -> None:
    sol = n_four_bar(2).simulate(times=[row[0] for row in A02["rows"]])
    expected = np.array(A02["rows"])
    rod = sol.body("rod 0")
    np.testing.assert_allclose(-np.sin(rod.theta - math.pi / 2), expected[:, 1], atol=1e-4)
    np.testing.assert_allclose(np.cos(rod.theta - math.pi / 2), expected[:, 2], atol=1e-4)
    assert np.ptp(sol.energy.total) < 1e-3


def test_massless_coupler_is_the_limit_of_light_ones() -> None:
    none = four_bar(0.0).simulate(1.0, tolerance=1e-10)
    light = four_bar(1e-7).simulate(1.0, tolerance=1e-10)
    np.testing.assert_allclose(none.body("rocker").theta, light.body("rocker").theta, atol=1e-7)
    np.testing.assert_allclose(none.joint("C").reaction, light.joint("C").reaction, atol=1e-4)
    coupler, pull = none.body("coupler"), none.joint("C").reaction
    along = np.stack([np.cos(coupler.theta), np.sin(coupler.theta)], axis=1)
    across = pull[:, 0] * along[:, 1] - pull[:, 1] * along[:, 0]
    assert np.abs(across).max() < 1e-9 * np.abs(pull).max(), "a massless rod carries load along its line alone"


def test_massless_body_that_nothing_holds_is_refused() -> None:
    m = Mechanism("loose")
    m.body("ghost")
    rod = m.bar("rod", 1.0, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    with pytest.raises(MobilityError, match="loose: 'ghost' has neither mass nor inertia, and can move in 3 ways"):
        m.simulate(0.5)


def test_massless_driven_links_without_load_just_move() -> None:
    m = Mechanism("bare", gravity=None)
    crank, coupler, rocker = m.bar("crank", 0.1), m.bar("coupler", 0.3), m.bar("rocker", 0.25)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(0.3, 0), rocker.start)
    m.drive_angle("motor", crank, constant_rate(3.0))
    m.start_near(crank=0, coupler=50, rocker=100)
    sol, swept = m.simulate(1.0, steps=30), m.sweep(1.0, steps=30)
    np.testing.assert_allclose(sol.body("rocker").theta, swept.body("rocker").theta, atol=1e-9)


def test_a_driven_simulation_is_the_sweep() -> None:
    m = four_bar(0.5)
    m.drive_angle("motor", m.bodies["crank"], constant_rate(5.0, math.radians(50)))
    swept, simulated = m.sweep(1.0, steps=50), m.simulate(1.0, steps=50, tolerance=1e-10)
    np.testing.assert_allclose(simulated.q, swept.q, atol=1e-9)
    np.testing.assert_allclose(simulated.driver("motor").torque, swept.driver("motor").torque, atol=1e-5)


def test_redundant_joints_share_their_load() -> None:
    m = Mechanism("double pin", gravity=(0.0, -G))
    rod = m.bar("rod", 1.0, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.revolute("A again", m.ground.at(0, 0), rod.start)
    sol = m.simulate(1.0)
    alone = Mechanism("pin", gravity=(0.0, -G))
    rod = alone.bar("rod", 1.0, mass=1.0)
    alone.revolute("A", alone.ground.at(0, 0), rod.start)
    single = alone.simulate(1.0)
    np.testing.assert_allclose(sol.body("rod").theta, single.body("rod").theta, atol=1e-9)
    np.testing.assert_allclose(sol.joint("A").reaction, single.joint("A").reaction / 2, atol=1e-9)


def test_given_start_is_held_and_the_rest_closes() -> None:
    sol = four_bar(0.5).simulate(0.01, steps=1)
    assert sol.body("crank").theta[0] == pytest.approx(math.radians(50), abs=1e-12)
    assert sol.changes, "the rough angles of coupler and rocker were changed, and that is told"
    assert any("coupler" in change for change in sol.changes)
    assert not any("crank" in change for change in sol.changes)


def test_given_velocities_are_of_the_frame_and_completed() -> None:
    m = four_bar(0.5)
    m.start_moving(crank=4.0)
    sol = m.simulate(0.01, steps=1)
    assert sol.body("crank").omega[0] == pytest.approx(4.0)
    assert sol.stats.velocity_residual < 1e-12
    free = Mechanism("free", gravity=None)
    free.body("plate", 2.0, com=(0.3, 0.1), inertia=0.4)
    free.start_moving(plate=(1.0, -2.0, 3.0))
    plate = free.simulate(0.5).body("plate")
    assert (plate.vx[0], plate.vy[0], plate.omega[0]) == pytest.approx((1.0, -2.0, 3.0))


def test_velocity_that_joints_forbid_is_changed_and_told() -> None:
    m = pendulum()
    m.start_moving(bob=(5.0, 0.0, 2.0))
    with pytest.warns(InitialConditionWarning, match="vx of 'bob' is 0 m/s, not 5"):
        sol = m.simulate(0.1)
    assert sol.body("bob").omega[0] == pytest.approx(2.0)


def test_same_inputs_same_outputs() -> None:
    first, second = n_four_bar(3).simulate(3.0), n_four_bar(3).simulate(3.0)
    assert first.q.tobytes() == second.q.tobytes()
    assert first.lam.tobytes() == second.lam.tobytes()


def test_refusals_name_the_remedy() -> None:
    m = pendulum()
    with pytest.raises(ModelError, match="duration"):
        m.simulate()
    with pytest.raises(ModelError, match="dop853"):
        m.simulate(1.0, method="euler")
    with pytest.raises(ModelError, match="tolerance"):
        m.simulate(1.0, tolerance=-1.0)
    m.drive_angle("motor", m.bodies["bob"], constant_rate(1.0))
    m.drive_angle("motor again", m.bodies["bob"], constant_rate(1.0))
    with pytest.raises(MobilityError, match="2 drivers for 1 degree"):
        m.simulate(1.0)


def hanging_chain(links: int) -> Mechanism:
    m = Mechanism("chain", gravity=(0.0, -G))
    before = m.ground.at(0, 0)
    for k in range(links):
        link = m.bar(f"link {k}", 0.1, mass=0.2)
        m.revolute(f"P{k}", before, link.start)
        m.start_near(**{f"link {k}": -90.0 + 40.0 * math.sin(k)})
        before = link.end
    m.start_moving(**{"link 0": 1.5})
    return m


@pytest.mark.parametrize("build", [lambda: n_four_bar(4), pendulum, lambda: hanging_chain(12)])
def test_the_route_of_large_mechanisms_starts_like_that_of_small_ones(build, monkeypatch: pytest.MonkeyPatch) -> None:
    m = build()
    small = prepare.prepare_dynamics(m, 0.0, 1.0)
    monkeypatch.setattr(prepare, "MANY_COORDINATES", 0)
    large = prepare.prepare_dynamics(m, 0.0, 1.0)
    np.testing.assert_allclose(large.initial.q, small.initial.q, atol=1e-11)
    np.testing.assert_allclose(large.initial.v, small.initial.v, atol=1e-9)
    assert large.mobility.dof == small.mobility.dof


def test_the_route_of_large_mechanisms_finds_redundant_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(prepare, "MANY_COORDINATES", 0)
    m = four_bar(0.5)
    m.revolute("C again", m.bodies["coupler"].end, m.bodies["rocker"].end)
    assert prepare.prepare_dynamics(m, 0.0, 1.0).mobility.redundant_rows == 2


def test_a_thousand_bodies_in_loops_keep_their_energy() -> None:
    sol = n_four_bar(500).simulate(1.0, steps=4, tolerance=1e-6)
    assert sol.stats.position_residual < 1e-9
    assert np.ptp(sol.energy.total) < 1e-6 * sol.energy.kinetic.max()
    assert sol.mobility.dof == 1


def test_links_of_a_large_mechanism_that_do_not_close_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(prepare, "MANY_COORDINATES", 0)
    m = four_bar(0.5)
    m.distance("tie", m.ground.at(5.0, 0.0), m.bodies["coupler"].end, 0.5)
    with pytest.raises(AssemblyError, match="stays open"):
        m.simulate(1.0)


def test_the_same_run_over_and_over_gives_the_same_bytes() -> None:
    """After some calls the machine code is called without a look at types (mbsd/compiling/jit.py)."""
    m = Mechanism("pendulum")
    rod = m.bar("rod", 0.5, 1.2)
    m.revolute("pin", m.ground.origin, rod.start)
    m.start_near(rod=20)
    method, times = integrator_named("pendulum", "dop853"), np.linspace(0.0, 1.0, 5)
    for formulation in ("reference", "independent"):
        ready = prepare.prepare_dynamics(m, 0.0, 1.0)
        runs = [integrate(ready, method, times, 1e-8, 1.0, formulation=formulation)[1] for _ in range(OFTEN + 5)]
        for out in runs[1:]:
            for repeated, first in zip(out, runs[0], strict=True):
                np.testing.assert_array_equal(repeated, first)
        [loop] = ready.advancing.values()
        assert not isinstance(loop._function, Dispatcher)


def _swinging() -> Mechanism:
    m = Mechanism("swinging")
    rod, bob = m.bar("rod", 0.5, 1.2), m.bar("bob", 0.3, 0.4)
    m.revolute("pin", m.ground.origin, rod.start)
    m.revolute("knee", rod.end, bob.start)
    m.torsion_spring("clock", m.ground, rod, 2.0)
    m.start_near(rod=20, bob=-30)
    return m


def _turned(m: Mechanism) -> None:
    m.start_near(rod=50, bob=-30)


def _moving(m: Mechanism) -> None:
    m.start_moving(rod=0.7)


def _lighter(m: Mechanism) -> None:
    m.change("clock", stiffness=3.0)


def _heavier(m: Mechanism) -> None:
    m.gravity = (0.0, -20.0)


def _held(m: Mechanism) -> None:
    m.weld("held", m.bodies["rod"].origin, m.bodies["bob"].at(0.1, 0.0))
    del m.joints["knee"]


@pytest.mark.parametrize("change", [_turned, _moving, _lighter, _heavier, _held])
def test_what_is_kept_between_runs_is_what_a_fresh_run_finds(change) -> None:
    """And nobody writes into it: the same model again gives the same bytes."""

    def run(m: Mechanism) -> bytes:
        sol = m.simulate(0.3, steps=6)
        return sol.q.tobytes() + sol.wrench.tobytes() + repr(sol.mobility).encode()

    # isinstance would ask weak references
    kept = [candidate for candidate in gc.get_objects() if type(candidate) is Kept]
    assert len(kept) > 3
    m = _swinging()
    before = run(m)
    assert run(m) == before
    change(m)
    after = run(m)
    assert after != before
    for cache in kept:
        cache._results.clear()
    anew = _swinging()
    change(anew)
    assert run(anew) == after == run(m)
    assert run(_swinging()) == before
