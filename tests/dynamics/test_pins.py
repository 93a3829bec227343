"""Mechanisms of many pins alone: what is left out for them changes no digit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.dynamics.reference.pins import MANY
from mbsd.dynamics.reference.projection import project


def tree(seed: int, links: int, loops: int) -> Mechanism:
    """Links that hang from one another at random, some of them with a second link between the same two."""
    random = np.random.default_rng(seed)
    m = Mechanism("tree")
    bodies = [m.ground]
    for k in range(links):
        mass = float(random.uniform(0.1, 2.0))
        link = m.body(f"link{k}", mass, inertia=mass * 0.01, com=(float(random.uniform(0.0, 0.2)), 0.01))
        before = bodies[int(random.integers(max(0, len(bodies) - 3), len(bodies)))]
        m.revolute(f"pin{k}", before.at(*random.uniform(-0.2, 0.2, 2)), link.at(0.0, 0.0))
        m.start_near(**{link.name: float(random.uniform(-60.0, 60.0))})
        bodies.append(link)
    for k in range(loops):  # two bars between bodies close a loop and leave all freedoms but two
        left, right = (bodies[int(n)] for n in random.choice(len(bodies), 2, replace=False))
        first, second = m.bar(f"first{k}", 3.0, mass=0.3), m.bar(f"second{k}", 3.0, mass=0.3)
        m.revolute(f"a{k}", left.at(0.1, 0.0), first.start)
        m.revolute(f"b{k}", first.end, second.start)
        m.revolute(f"c{k}", second.end, right.at(0.1, 0.0))
    m.spring("spring", m.ground.at(0.5, 0.5), bodies[-1].at(0.1, 0.0), stiffness=40.0, free_length=0.1, damping=0.3)
    return m


def _of(ready: PreparedDynamics, pins: bool, state: np.ndarray) -> list[np.ndarray]:
    """Derivative, multipliers and margin at a state (2, 3 nb), then the state as it is projected, and how far."""
    dynamics = ready.dynamics
    if not pins:
        dynamics = dynamics._replace(schur=dynamics.schur._replace(pins=dynamics.schur.pins[:0]))
    scratch = scratch_for(dynamics, ready.packed.ws, 0, 1)
    out, lam, state = np.zeros_like(state), np.zeros(len(ready.packed.ws.phi)), state.copy()
    power = derivative(dynamics, scratch, 0.0, state, out, lam)
    margin = scratch.report[0]
    project(dynamics, scratch, 0.0, state, 2)
    return [out[:, 3:], lam, np.array([power, margin]), state[:, 3:], scratch.report[1:3].copy()]


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6), st.integers(MANY, 2 * MANY), st.integers(0, 2))
def test_what_is_left_out_for_pins_changes_no_digit(seed: int, links: int, loops: int) -> None:
    ready = prepare_dynamics(tree(seed, links, loops), 0.0, 1.0)
    assert ready.dynamics.schur.pins.shape == (links + 3 * loops, 2)
    random = np.random.default_rng(seed + 1)
    state = np.stack([ready.initial.q, ready.initial.v])
    state[:, 3:] += random.standard_normal(state[:, 3:].shape) * [[1e-3], [2.0]]
    for own, general in zip(_of(ready, True, state), _of(ready, False, state), strict=True):
        assert np.isfinite(general).all()
        assert (own == general).all()


@pytest.mark.parametrize("more", ["none", "driver", "weld", "friction", "event", "redundant", "light", "few"])
def test_other_mechanisms_are_not_taken_for_pins(more: str) -> None:
    m = Mechanism("chain")
    last, first = m.ground.at(0.0, 0.0), m.bar("bar0", 0.1, mass=0.1)
    bar = first
    for k in range(MANY - (more == "few")):
        bar = m.bar(f"bar{k}", 0.1, mass=0.0 if more == "light" and k % 2 == 0 else 0.1) if k else first
        m.revolute(f"pin{k}", last, bar.start)
        m.start_near(**{bar.name: -60.0 + 3.0 * k})
        last = bar.end
    if more == "driver":
        m.drive_angle("motor", bar, constant_rate(1.0))
    elif more == "weld":
        m.weld("weld", last, m.body("more", 0.1, inertia=0.001).at(0.0, 0.0))
    elif more == "friction":
        m.friction("rubbing", "pin0", 0.1, radius=0.01)
    elif more == "event":
        m.event("passes", lambda t, moment: t - 0.5)
    elif more == "redundant":
        m.revolute("again", m.ground.at(0.0, 0.0), first.start)
    pins = prepare_dynamics(m, 0.0, 1.0).dynamics.schur.pins
    assert len(pins) == (MANY if more == "none" else 0)
