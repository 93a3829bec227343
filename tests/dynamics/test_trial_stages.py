"""Functions of the user that overflow, or leave their domain, in states that integrators only try."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest

from mbsd import Mechanism, ModelError, SimulationError


def _braked(function, speed: float) -> Mechanism:
    m = Mechanism("brake", gravity=None)
    sledge = m.body("sledge", 1.0, inertia=1.0)
    m.user_force("drag", function, sledge)
    m.start_moving(sledge=(speed, 0.0, 0.0))
    return m


def _exponential(t, q, v):
    return 1.0 - math.exp(50.0 * v[0]), 0.0, 0.0


def _root(t, q, v):
    return math.sqrt(0.5 - t), 0.0, 0.0


@pytest.mark.parametrize("method", ["dop853", "radau"])
@pytest.mark.parametrize("function", [_exponential, numba.njit(_exponential)], ids=["Python", "numba"])
def test_a_stage_that_overflows_shortens_the_step(function, method: str) -> None:
    """v' = 1 - exp(50 v):  exp(-50 v) = 1 - (1 - exp(-50 v0)) exp(-50 t), and v0 = 0.4 pushes with 5e8 N."""
    sol = _braked(function, 0.4).simulate(0.1, steps=10, method=method, tolerance=1e-9)
    expected = -np.log(1.0 - (1.0 - math.exp(-20.0)) * np.exp(-50.0 * sol.t)) / 50.0
    np.testing.assert_allclose(sol.body("sledge").vx, expected, atol=1e-7)


@pytest.mark.parametrize("method", ["dop853", "radau"])
@pytest.mark.parametrize("function", [_root, numba.njit(_root)], ids=["Python", "numba"])
def test_what_fails_however_short_the_step_is_an_error_with_force_time_and_number(function, method: str) -> None:
    said = r"brake: force 'drag': at t = 0\.5 s with \[.*\] the user's function (fails: ValueError|gives \[nan)"
    with pytest.raises(ModelError, match=said):
        _braked(function, 0.4).simulate(1.0, steps=10, method=method)


def test_what_is_no_number_is_told_at_once() -> None:
    def forgetful(t, q, v):
        return unknown, 0.0, 0.0  # noqa: F821  # pyright: ignore[reportUndefinedVariable]

    with pytest.raises(ModelError, match=r"at t = 0 s with .* NameError"):
        _braked(forgetful, 0.4).simulate(1.0, steps=10)
    with pytest.raises(ModelError, match=r"at t = 0\.5\d* s with .* ValueError"):
        _braked(_root, 0.4).simulate(1.0, method="rk4", step=0.01)


def test_an_overflow_long_ago_is_not_blamed_for_another_end() -> None:
    def sharp(t, q, v):
        return 1.0 - math.exp(50.0 * v[0]), 1.0 / (0.3 - t) if t < 0.3 else 1e12, 0.0

    with pytest.raises(SimulationError, match=r"stops at t = 0\.3 s"):
        _braked(sharp, 0.4).simulate(1.0, steps=10)
