"""Random open and closed chains with springs move as Exudyn moves them. Needs the extra ``bench``."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.dynamics import mbsd_code
from benchmarks.dynamics.cases import Case
from benchmarks.dynamics.pins import GROUND, Pin, Pinned, Solid, Spring, closure

pytest.importorskip("exudyn", reason="needs exudyn, which the extra bench installs")
from benchmarks.dynamics import exudyn_code

DURATION = 0.4
STEPS = 2000
"""Of Exudyn's coarser run; the finer one has twice as many, and both give the limit of the second-order rule."""


def chain(seed: int, links: int, closed: bool) -> Pinned:
    """Links of 0.2 to 0.5 m with centres of mass off the line, each with a spring or a torque now and then.

    An open chain starts moving; a closed one starts at rest with its last end pinned to the ground where it is.
    """
    rng = np.random.default_rng(seed)
    solids: list[Solid] = []
    pins: list[Pin] = []
    springs: list[Spring] = []
    joint, velocity, before, end = np.zeros(2), np.zeros(2), GROUND, (0.0, 0.0)
    for k in range(links):
        length, angle = rng.uniform(0.2, 0.5), rng.uniform(-math.pi, math.pi)
        omega = 0.0 if closed else rng.uniform(-4, 4)
        centre = np.array([rng.uniform(0.3, 0.7) * length, rng.uniform(-0.1, 0.1) * length])
        turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
        arm = turn @ centre
        place, speed = joint + arm, velocity + omega * np.array([-arm[1], arm[0]])
        mass = rng.uniform(0.3, 2.0)
        inertia = mass * length**2 * rng.uniform(0.05, 0.2)
        solids.append(
            Solid(mass, inertia, (float(place[0]), float(place[1]), angle), (float(speed[0]), float(speed[1]), omega))
        )
        pins.append(Pin(before, end, k, (float(-centre[0]), float(-centre[1]))))
        hook = (float(rng.uniform(-0.1, 0.1)), float(rng.uniform(-0.1, 0.1)))
        anchor = (float(rng.uniform(-1, 1)), float(rng.uniform(0.5, 1.5)))
        springs.append(Spring(GROUND, anchor, k, hook, float(rng.uniform(5, 60)), float(rng.uniform(0.2, 0.8))))
        reach = turn @ np.array([length, 0.0])
        joint, velocity = joint + reach, velocity + omega * np.array([-reach[1], reach[0]])
        before, end = k, (float(length - centre[0]), float(-centre[1]))
    if links > 2:
        springs.append(Spring(0, (0.1, 0.05), links - 1, (0.0, 0.1), float(rng.uniform(5, 60)), 0.3))
    if closed:
        pins.append(Pin(GROUND, (float(joint[0]), float(joint[1])), before, end))
    return Pinned(tuple(solids), tuple(pins), 9.81, ((0, float(rng.uniform(-1, 1))),), tuple(springs))


def ends(model: Pinned) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Poses and velocities at the end by mbsd and by Exudyn, and how far Exudyn's steps move them; (2, bodies, 3)."""
    problem = Case("chain", model, DURATION, {}, 0.0, lambda record: {})
    record = mbsd_code.prepare(problem, {"method": "dop853", "tolerance": 1e-11})[1]()
    ours = np.stack([record.poses[-1], record.velocities[-1]])
    last_states = []
    for steps in (STEPS, 2 * STEPS):
        rule = {"model": "pins", "solver": "TrapezoidalIndex2", "rho": 1.0, "newton": "full"}
        record = exudyn_code.prepare(problem, rule | {"linear": "EXUdense", "tolerance": 1e-10, "steps": steps})[1]()
        assert record.times[-1] == pytest.approx(DURATION)
        last_states.append(np.stack([record.poses[-1], record.velocities[-1]]))
    coarse, fine = last_states
    return ours, fine + (fine - coarse) / 3, np.abs(fine - coarse)


@pytest.mark.parametrize("closed", [False, True], ids=["open", "closed"])
@given(seed=st.integers(0, 10**6), links=st.integers(3, 5))
@settings(max_examples=10)
def test_chains_with_springs(closed: bool, seed: int, links: int) -> None:
    model = chain(seed, links, closed)
    assert closure(model) < 1e-12
    ours, theirs, doubt = ends(model)
    assert np.abs(ours - model.start).max() > 0.01  # it moves
    for computed, expected, steps in zip(ours, theirs, doubt, strict=True):
        scale = max(1.0, float(np.abs(expected).max()))
        assert np.abs(computed - expected).max() < 1e-7 * scale + 0.005 * steps.max()
