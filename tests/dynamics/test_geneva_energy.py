"""A Geneva's acceleration jumps where its pin enters and leaves: no energy comes or goes there."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism
from tools.models.guided import two_genevas


def free_geneva(slots: int, gravity: tuple[float, float] | None, speed: float = 10.0) -> Mechanism:
    """A crank with a flywheel's inertia that turns a wheel and its own unbalance."""
    m = Mechanism("geneva", gravity=gravity)
    crank, wheel = m.body("crank", 0.5, (0.01, 0.0), 1e-3), m.body("wheel", 1.0, (0.0, 0.0), 2e-3)
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(0.1, 0), wheel.origin)
    m.geneva("index", crank.origin, wheel.origin, slots, 0.1 * math.sin(math.pi / slots))
    m.start_near(wheel=5)
    m.start_moving(crank=speed)
    return m


@pytest.mark.parametrize("slots", [4, 6])
@pytest.mark.parametrize("gravity", [None, (0.0, -9.81)])
def test_no_index_changes_the_energy(slots: int, gravity: tuple[float, float] | None) -> None:
    sol = free_geneva(slots, gravity).simulate(3.0, steps=200, tolerance=1e-9, formulation="independent")
    assert sol.stats.independent
    assert np.ptp(sol.audit) < 3e-9 * sol.energy.total[0]
    other = free_geneva(slots, gravity).simulate(3.0, steps=200, tolerance=1e-10, formulation="reference")
    np.testing.assert_allclose(sol.body("crank").theta, other.body("crank").theta, atol=3e-7)


def test_a_crank_that_swings_back_at_its_slot_is_followed() -> None:
    """It passes jumps again and again; one that is passed there and back within a step errs by the tolerance."""
    for speed in (0.2, 1.0, 2.3, 4.0):
        m = free_geneva(4, (0.0, -9.81), speed)
        m.torsion_spring("spring", m.ground, m.bodies["crank"], 0.02)
        sol = m.simulate(3.0, steps=100, tolerance=1e-9, formulation="independent")
        assert np.ptp(sol.audit) < 1e-8, speed


def test_a_start_at_the_jump_and_two_genevas_at_once() -> None:
    m = two_genevas()
    sol = m.simulate(3.0, steps=100, tolerance=1e-9, formulation="independent")
    assert np.ptp(sol.audit) < 3e-9 * sol.energy.total[0]
