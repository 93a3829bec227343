"""Reactions, efforts, weight and inertia balance on every body, by Newton and Euler, of any motion."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd.spatial import Mechanism, harmonic
from mbsd.spatial.model.rotation import rotation_matrix
from mbsd.spatial.results.solution import Solution
from tests.spatial import machines


def unbalanced(sol: Solution) -> float:
    """Return the largest force (N) or moment (N m) about a centre of mass that nothing balances."""
    m: Mechanism = sol.mechanism
    forces = {name: np.zeros((len(sol.t), 3)) for name in m.bodies}
    moments = {name: np.zeros((len(sol.t), 3)) for name in m.bodies}
    centres = {name: sol.place(body.marker(body.com)) for name, body in m.bodies.items()}

    def act(joint, place: np.ndarray, force: np.ndarray, moment: np.ndarray) -> None:
        for name, sign in zip(joint.bodies, (-1.0, 1.0), strict=True):
            forces[name] += sign * force
            moments[name] += sign * (moment + np.cross(place - centres[name].place, force))

    for name, joint in m.joints.items():
        view = sol.joint(name)
        act(joint, view.place, view.force, view.moment)
    for name, driver in m.drivers.items():
        effort = sol.driver(name).effort[:, None]
        i, j = sol.place(driver.i), sol.place(driver.j)
        axis, none = i.rotation[:, :, 2], np.zeros((len(sol.t), 3))
        if driver.kind.name == "drive_turn":
            act(driver, j.place, none, effort * axis)
        elif driver.kind.name == "drive_slide":
            act(driver, j.place, effort * axis, none)
        else:
            way = j.place - i.place
            act(driver, j.place, effort * way / np.linalg.norm(way, axis=1)[:, None], none)
    worst = 0.0
    for name, body in list(m.bodies.items())[1:]:
        frame = sol.body(name)
        inertia = frame.rotation @ np.array(body.inertia) @ np.swapaxes(frame.rotation, 1, 2)
        spin = np.einsum("tij,tj->ti", inertia, frame.w)
        turning = np.einsum("tij,tj->ti", inertia, frame.alpha) + np.cross(frame.w, spin)
        pull = body.mass * (centres[name].acceleration - np.array(m.gravity))
        worst = max(worst, np.abs(forces[name] - pull).max(), np.abs(moments[name] - turning).max())
    return float(worst)


BUILDS = [
    machines.slider_crank,
    machines.four_link,
    machines.bennett,
    machines.sarrus,
    lambda: machines.hooke_joint(math.radians(35)),
    lambda: machines.hooke_pair(math.radians(20), True),
]


@pytest.mark.parametrize("build", BUILDS)
def test_all_that_acts_on_a_body_balances_in_a_sweep(build) -> None:
    sol = build().sweep(duration=0.9, steps=40)
    size = max(np.abs(sol.joint(name).force).max() for name in sol.mechanism.joints) + 1.0
    assert unbalanced(sol) < 1e-9 * size


@pytest.mark.parametrize("build", [machines.bricard, machines.bennett, machines.slider_crank])
@pytest.mark.parametrize("formulation", ["tree", "reference"])
def test_all_that_acts_on_a_body_balances_in_a_simulation(build, formulation: str) -> None:
    sol = build().simulate(duration=0.7, steps=20, tolerance=1e-9, formulation=formulation)
    size = max(np.abs(sol.joint(name).force).max() for name in sol.mechanism.joints) + 1.0
    assert unbalanced(sol) < 1e-8 * size


def random_tree(seed: int) -> tuple[Mechanism, list[tuple]]:
    """Return an open tree of four bodies with driven joints, and each joint: its bodies, place, axis, turn, slide."""
    random = np.random.default_rng(seed)
    m, joints = Mechanism("tree"), []
    for k in range(4):
        inertia = rotation_matrix(random.standard_normal(4))
        moments = random.uniform(0.2, 0.3, 3)
        m.body(
            f"body {k}",
            random.uniform(0.5, 2.0),
            com=random.uniform(-1, 1, 3),
            inertia=inertia @ np.diag(moments) @ inertia.T,
            at=random.uniform(-1, 1, 3),
            orientation=random.standard_normal(4),
        )
        before = "ground" if k == 0 else f"body {random.integers(k)}"
        at, axis = random.uniform(-1, 1, 3), random.standard_normal(3)
        kind = random.choice(["revolute", "prismatic", "cylindrical"])
        getattr(m, kind)(f"joint {k}", before, f"body {k}", at=at, axis=axis)
        turn, slide = (harmonic(*random.uniform(0.3, 1.5, 2)) for _ in range(2))
        if kind != "prismatic":
            m.drive_turn(f"turn {k}", f"joint {k}", turn)
        if kind != "revolute":
            m.drive_slide(f"slide {k}", f"joint {k}", slide)
        joints.append(
            (before, at, axis / np.linalg.norm(axis), None if kind == "prismatic" else turn,
             None if kind == "revolute" else slide)
        )  # fmt: skip
    return m, joints


@settings(max_examples=15)
@given(seed=st.integers(0, 2**32 - 1))
def test_random_trees_move_as_products_of_their_joints(seed: int) -> None:
    """Forward kinematics by products of exponentials from the design pose; Newton and Euler for reactions."""
    m, joints = random_tree(seed)
    sol = m.sweep(times=np.linspace(0.0, 2.0, 9))
    for row, t in enumerate(sol.t):
        moved = {"ground": np.eye(4)}
        for k, (before, at, axis, turn, slide) in enumerate(joints):
            angle = 0.0 if turn is None else turn(np.array([t]))[0, 0]
            way = 0.0 if slide is None else slide(np.array([t]))[0, 0]
            own = np.eye(4)
            own[:3, :3] = machines.about(axis, angle)
            own[:3, 3] = at - own[:3, :3] @ at + way * axis
            moved[f"body {k}"] = moved[before] @ own
            body = m.bodies[f"body {k}"]
            pose = moved[f"body {k}"]
            frame = sol.body(f"body {k}")
            assert np.allclose(frame.place[row], pose[:3, :3] @ body.place + pose[:3, 3], rtol=0, atol=1e-10)
            assert np.allclose(frame.rotation[row], pose[:3, :3] @ body.rotation, rtol=0, atol=1e-10)
    size = max(np.abs(sol.joint(name).force).max() for name in m.joints) + 1.0
    assert unbalanced(sol) < 1e-9 * size
    assert sol.mobility.redundant_rows == 0


@settings(max_examples=6)
@given(seed=st.integers(0, 2**32 - 1))
def test_random_trees_keep_their_energy_when_they_fall(seed: int) -> None:
    m, _ = random_tree(seed)
    m.drivers.clear()
    m.start_moving({"joint 0": 0.7})
    sol = m.simulate(duration=1.0, steps=10, tolerance=1e-10)
    total = sol.energy.total
    assert np.ptp(total) < 1e-6 * (np.abs(sol.energy.kinetic).max() + np.abs(sol.energy.potential).max() + 1.0)
    assert unbalanced(sol) < 1e-7 * (1.0 + max(np.abs(sol.joint(name).force).max() for name in m.joints))
    assert sol.stats.position_residual < 1e-8
