"""What only single simulations could do once is done in the loop of many, too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism
from mbsd.base.errors import SimulationError
from mbsd.compiling.jit import kernel
from mbsd.dynamics.events.refusals import taking_turns
from mbsd.dynamics.events.sticking.deciding import solve_least
from mbsd.model.event import Happening


def discs(count: int) -> Mechanism:
    """Discs that fall side by side on a floor, each by its own rail."""
    m = Mechanism("discs", gravity=(0, -9.81))
    for k in range(count):
        disc = m.body(f"d{k}", 1.0, inertia=0.01)
        m.rigid_contact(f"floor{k}", m.ground.origin, disc.origin, radius=0.1, restitution=0.5)
    m.start_near(**{f"d{k}": (0.3 * k, 0.2 + 0.01 * k, 0.0) for k in range(count)})
    return m


@pytest.mark.parametrize("method", ["rk4", "radau", "generalized_alpha", "scipy-dop853"])
def test_every_integrator_meets_a_bounce(method: str) -> None:
    m = discs(1)
    options = {"step": 1e-4} if method in ("rk4", "generalized_alpha") else {}
    sol, exact = (m.simulate(0.5, steps=5, **more) for more in ({"method": method, **options}, {"tolerance": 1e-11}))
    assert [event.what for event in sol.events] == [event.what for event in exact.events]
    np.testing.assert_allclose([event.time for event in sol.events], [event.time for event in exact.events], atol=1e-6)
    np.testing.assert_allclose(sol.body("d0").y, exact.body("d0").y, atol=1e-6)


def test_contacts_that_carry_in_turns_are_named() -> None:
    feet = [("left", "opens"), ("right", "closes"), ("left", "closes"), ("right", "opens")]
    changes = [Happening(0.5 + 1e-9 * k, *feet[k % 4]) for k in range(150)]
    with pytest.raises(SimulationError, match=r"walker: near t = 0.5 s 'left' and 'right' carry in turns"):
        raise taking_turns("walker", changes, 1.0) or AssertionError
    slow = [replace(happening, time=0.5 + 1e-3 * k) for k, happening in enumerate(changes)]
    assert taking_turns("walker", slow, 1.0) is None
    assert taking_turns("walker", changes[:50], 1.0) is None
    assert taking_turns("walker", [replace(happening, what="impact") for happening in changes], 1.0) is None


@kernel
def least(table, n):
    """``solve_least`` for tests."""
    solve_least(table, n)


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 7), st.integers(1, 7), st.integers(0, 2**32 - 1))
def test_the_shortest_solution_is_that_of_numpy(n: int, rank: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    matrix = random.normal(size=(n, rank)) @ random.normal(size=(rank, n))
    right = random.normal(size=n)
    table = np.zeros((n, 2 * n + 2))
    table[:, :n], table[:, n : 2 * n], table[:, 2 * n] = matrix, np.eye(n), right
    least(table, n)
    expected = np.linalg.lstsq(matrix, right, rcond=1e-10)[0]
    np.testing.assert_allclose(table[:, 2 * n + 1], expected, atol=1e-6 * max(1.0, np.abs(expected).max()))
