"""Free Genevas in independent coordinates whose jumps fall where rounding decides: on the jump, at the end."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.results.solution import Solution
from tools.models.guided import free_geneva, two_genevas

CENTRES = 0.2


def _geneva(slots: int, start: float, omega: float) -> Mechanism:
    """A crank and a wheel without gravity; ``start``: the crank's angle (rad)."""
    m = Mechanism("geneva")
    m.gravity = (0.0, 0.0)
    crank = m.body("crank", 1.4, inertia=0.07)
    wheel = m.body("wheel", 2.0, inertia=0.03)
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(CENTRES, 0), wheel.origin)
    m.geneva("geneva", crank.origin, wheel.origin, slots=slots, radius=CENTRES * math.sin(math.pi / slots))
    m.start_near(crank=math.degrees(start), wheel=180 / slots)
    m.start_moving(crank=omega)
    return m


def _agree(sol: Solution, other: Solution) -> None:
    for body in ("crank", "wheel"):
        np.testing.assert_allclose(sol.body(body).theta, other.body(body).theta, atol=2e-4)
        np.testing.assert_allclose(sol.body(body).omega, other.body(body).omega, atol=5e-3)
    assert sol.stats.position_residual < 1e-12


@pytest.mark.parametrize("slots", [4, 5, 6, 7, 9])
def test_a_pin_that_leaves_its_slot_soon_after_the_start(slots: int) -> None:
    """One of many starts ends a step on the jump to the last digit: x - r is zero."""
    leaves = math.pi / 2 - math.pi / slots
    for k in range(12):
        m = _geneva(slots, -leaves + 0.002 * (1 + k), -13.0)
        _agree(m.simulate(0.4, steps=20, formulation="independent"), m.simulate(0.4, steps=20, formulation="reference"))


def test_the_case_that_went_on_for_five_times_its_duration() -> None:
    m = Mechanism("geneva")
    crank = m.body("crank", 1.38349482, com=(-0.10287317785064908, -0.03324008862003943), inertia=0.0694458803)
    wheel = m.body("wheel", 2.0668874, com=(-0.004337923730833741, -0.01634389937865299), inertia=0.0299827072)
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(0.23106923800257428, 0), wheel.origin)
    m.geneva("geneva", crank.origin, wheel.origin, slots=7, radius=0.10025718497960188)
    m.start_near(crank=math.degrees(-1.1090864575789432), wheel=180 / 7)
    m.start_moving(crank=-13.63970146582763)
    sol = m.simulate(0.456, steps=60, formulation="independent")
    assert sol.stats.position_residual < 1e-12
    _agree(sol, m.simulate(0.456, steps=60, formulation="reference"))


def test_a_run_that_ends_on_a_jump_has_its_last_row() -> None:
    """The jump is gone over in time, maybe beyond the end."""
    slots, omega = 5, 10.0
    leaves = math.pi / 2 - math.pi / slots
    start = -leaves - 0.3
    at = 0.3 / omega  # nothing pushes the crank before its pin enters the slot
    for ulps in range(-12, 13, 2):
        end = at + ulps * math.ulp(at)
        sol = _geneva(slots, start, omega).simulate(end, steps=3, formulation="independent")
        assert sol.body("crank").theta[-1] == pytest.approx(-leaves, abs=1e-9)
        assert sol.body("wheel").x[-1] == CENTRES


def test_a_step_that_begins_right_after_a_jump_and_ends_beyond_the_next() -> None:
    """Its gap is rounding there and moves away: the next jump is looked for in time, not by how the gap falls."""
    m = free_geneva(6)
    m.change("spring", stiffness=0.013244147157190635)
    sol = m.simulate(2.0, steps=20, tolerance=1e-9, formulation="independent")
    assert np.ptp(sol.audit) < 1e-8
    other = m.simulate(2.0, steps=20, formulation="independent")
    np.testing.assert_allclose(other.body("crank").theta, sol.body("crank").theta, atol=1e-4)


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
        m = free_geneva(4, speed=speed)
        m.change("spring", stiffness=0.02)
        sol = m.simulate(3.0, steps=100, tolerance=1e-9, formulation="independent")
        assert np.ptp(sol.audit) < 1e-8, speed


def test_a_start_at_the_jump_and_two_genevas_at_once() -> None:
    m = two_genevas()
    sol = m.simulate(3.0, steps=100, tolerance=1e-9, formulation="independent")
    assert np.ptp(sol.audit) < 3e-9 * sol.energy.total[0]
