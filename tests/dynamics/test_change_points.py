"""Reactions of simulations at and near change points: those of poses beside, or NaN with a note."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mbsd.measures import largest, samples

G = 9.80665
RATE = 2 * math.pi


def parallelogram(is_driven: bool, has_weight: bool = True) -> Mechanism:
    """Cranks of 0.1 m on a coupler of 0.3 m, 1 kg each, from 60 degrees at one turn a second."""
    m = Mechanism("parallelogram") if has_weight else Mechanism("parallelogram", gravity=None)
    left, right, coupler = m.bar("left", 0.1, mass=1.0), m.bar("right", 0.1, mass=1.0), m.bar("coupler", 0.3, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), left.start)
    m.revolute("B", left.end, coupler.start)
    m.revolute("C", coupler.end, right.end)
    m.revolute("D", m.ground.at(0.3, 0), right.start)
    m.start_near(left=60, right=60, coupler=0)
    if is_driven:
        m.drive_angle("motor", left, constant_rate(RATE, math.pi / 3))
    else:
        m.start_moving(left=RATE)
    return m


@pytest.mark.parametrize("method", ["dop853", "radau"])
@pytest.mark.parametrize("steps", [359, 360])
def test_a_driven_simulation_gives_the_torque_of_statics(method: str, steps: int) -> None:
    sol = parallelogram(True).simulate(1.0, steps=steps, method=method)
    theta = math.pi / 3 + RATE * sol.t
    np.testing.assert_allclose(sol.driver("motor").torque, 0.2 * G * np.cos(theta), atol=1e-7)
    np.testing.assert_allclose(np.sin(sol.body("coupler").theta), 0.0, atol=1e-9)
    np.testing.assert_allclose(sol.body("coupler").alpha, 0.0, atol=1e-6)
    assert np.flatnonzero(~sol.is_defined).tolist() == ([120, 300] if steps == 360 else [])
    assert len(sol.notes) == (2 if steps == 360 else 0)


@pytest.mark.parametrize("digits", [4, 6, 15])
def test_a_free_spin_has_the_pin_forces_of_inertia(digits: int) -> None:
    """No weight: the pins carry the coupler's inertia, half of 1 kg at 0.1 m each."""
    sol = parallelogram(False, False).simulate(times=np.round(np.linspace(0.0, 1.0, 361), digits))
    np.testing.assert_allclose(sol.joint("C").magnitude, 0.05 * RATE**2, rtol=1e-6)
    between = sol.at([1 / 3, 0.5, 5 / 6])
    np.testing.assert_allclose(between.joint("C").magnitude, 0.05 * RATE**2, rtol=1e-6)


def test_a_swing_through_the_flat_pose_has_the_work_of_its_weight() -> None:
    m = parallelogram(False)
    sol = m.simulate(1.0, steps=500, tolerance=1e-10)
    assert np.ptp(sol.audit) < 1e-7
    force = sol.joint("C").fx * np.sin(sol.body("right").theta)  # its moment about D, over the length of the crank
    inertia = m.bodies["right"].inertia + 0.05**2
    right = sol.body("right")
    moment = 0.1 * (sol.joint("C").fy * np.cos(right.theta) - force)
    weight = 0.05 * G * np.cos(right.theta)
    known = sol.is_defined
    np.testing.assert_allclose(moment[known], (inertia * right.alpha + weight)[known], atol=1e-5)


@pytest.mark.parametrize("is_simulated", [False, True])
def test_other_actuators_pass_as_well(is_simulated: bool) -> None:
    m = parallelogram(True)
    m.torque("push", m.bodies["right"], 0.0)
    motion = m.simulate(1.0, steps=360) if is_simulated else m.sweep(1.0)
    for name in ("motor", "push"):
        actuated = m.inverse_dynamics(motion, [name])
        np.testing.assert_allclose(actuated.efforts[name], 0.2 * G * np.cos(motion.body("left").theta), atol=1e-6)
        assert np.isnan(actuated.solution.joint("C").fx).sum() == 2


@pytest.mark.parametrize("formulation", ["auto", "reference"])
def test_many_simulations_have_the_reactions_of_single_ones_near_change_points(formulation: str) -> None:
    m, times = parallelogram(False), np.round(np.linspace(0.0, 1.0, 361), 4)
    masses = np.array([0.5, 1.0, 1.7])
    measures = {name: samples(name, times.tolist()) for name in ("C.fx", "C.fy", "A.fx", "coupler.ax")}
    many = m.simulate_many(
        times=times, vary={"coupler": {"mass": masses}}, measure=measures, tolerance=1e-9, formulation=formulation
    )
    assert all(why == "it came near a singular pose" for why in many.alone)
    for k, mass in enumerate(masses):
        m.change("coupler", mass=mass)
        sol = m.simulate(times=times, tolerance=1e-9, formulation=formulation)
        np.testing.assert_allclose(many["C.fx"][k], sol.joint("C").fx, rtol=1e-9)
        np.testing.assert_allclose(many["A.fx"][k], sol.joint("A").fx, rtol=1e-9)
        force = many["C.fx"][k] * np.sin(sol.body("right").theta)
        assert np.nanmax(np.abs(np.diff(force, 2))) < 0.05 * np.nanmax(np.abs(force))


def test_many_simulations_away_from_change_points_stay_together() -> None:
    m = parallelogram(False)
    many = m.simulate_many(0.1, vary={"coupler": {"mass": [0.5, 1.0]}}, measure={"f": largest("C.fx")}, steps=36)
    assert many.alone == [None, None]


@pytest.mark.parametrize("extra", [[0.0, 1e-3], [1e-3, 0.0], [0.0, 0.0, 1e-3], [0.0, 1e-2, 0.0, 0.0]])
def test_loops_in_a_row_pass_their_change_points_beside_one_that_is_not_exact(extra: list[float]) -> None:
    m, length = Mechanism("row"), 1.3
    rods = [m.bar(f"rod{k}", length, mass=1.0) for k in range(len(extra) + 1)]
    for k, rod in enumerate(rods):
        m.revolute(f"foot{k}", m.ground.at(k * length, 0.0), rod.start)
    for k, (left, right, more) in enumerate(zip(rods, rods[1:], extra, strict=False)):
        deck = m.bar(f"deck{k}", length, mass=1.0)
        m.revolute(f"left{k}", left.end, deck.start)
        m.revolute(f"right{k}", deck.at(length + more, 0.0), right.end)
    starts = {name: 113.0 if name.startswith("rod") else 0.0 for name in m.bodies if name != "ground"}
    m.start_near(**starts)
    m.start_moving(rod0=0.48)
    sol = m.simulate(1.34, steps=20, tolerance=1e-9)
    assert np.ptp(sol.energy.total) < 1e-8 * sol.energy.kinetic.max()
    finer = m.simulate(1.34, steps=20, tolerance=1e-11)
    assert np.abs(sol.q - finer.q).max() < 1e-8


@pytest.mark.parametrize("aside", [-9e-5, 1.3e-4])
def test_a_loop_off_by_a_part_in_a_hundred_million_passes_its_change_point(aside: float) -> None:
    """Its links turn over within 1e-4 rad of the flat pose, beside a loop that is exact there."""
    m, length = Mechanism("row"), 0.64582560801867
    rods = [m.bar(f"rod{k}", length, mass=1.0) for k in range(3)]
    for k, rod in enumerate(rods):
        m.revolute(f"foot{k}", m.ground.at(k * length, 0.0), rod.start)
    for k, (left, right, y) in enumerate(zip(rods, rods[1:], (aside, 0.0), strict=False)):
        deck = m.bar(f"deck{k}", length, mass=1.0)
        m.revolute(f"left{k}", left.end, deck.start)
        m.revolute(f"right{k}", deck.at(length, y), right.end)
    m.start_near(rod0=95.96, rod1=95.96, rod2=95.96, deck0=0.0, deck1=0.0)
    m.start_moving(rod0=0.3085)
    sol = m.simulate(0.78, steps=13, tolerance=1e-9)
    assert sol.stats.steps < 1000
    assert np.ptp(sol.energy.total) < 1e-5 * sol.energy.kinetic.max()
