"""Motions of the compiled loop over many simulations beside those of single ones, with friction."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pytest
from hypothesis import strategies as st

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.measures import samples
from mbsd.results.solution import Solution

EXACT, ERROR = 2e-9, 10.0
"""How far motions may differ, beside so many times what a smaller tolerance changes: rounding at an event moves
the steps after it, and where a normal force has a kink, the error of the method with them. Such a change is a sample
of the error; among some hundred slider-cranks a single one was up to four times too small."""
ROUNDED = 30.0
"""How far they may differ in tolerances: after joints that stick and slip within a millisecond, rounding of a mass
moves a single simulation by some ten tolerances."""
SMALLER = (0.1, 0.4)
"""Tolerances of these samples, as parts of the one that is tested."""
ROUNDINGS = [2e-15 * sign * k for k in range(1, 61) for sign in (1, -1)]
"""Parts by which a mass is moved where motions differ by more, to see what rounding does to single simulations: where
friction by the rate turns over, 8 of 300 had a step with an error of 15000 tolerances."""
PARTS = ("x", "theta", "omega")


def between(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers of a machine."""
    return st.floats(low, high, allow_nan=False)


def assert_as_single_ones(m: Mechanism, body: str, duration: float, steps: int, tolerance: float) -> list[int]:
    """Two masses of a body in the loop and alone; returns how many events single simulations met.

    Raises AssertionError where motions differ, or where a reason is not that of the single simulation.
    """
    times = np.linspace(0.0, duration, steps + 1)
    measure = {part: samples(f"{body}.{part}", times.tolist()) for part in PARTS}
    masses, met = [m.bodies[body].mass, 1.1 * m.bodies[body].mass], []
    many = m.simulate_many(vary={body: {"mass": masses}}, measure=measure, times=times, tolerance=tolerance, threads=1)
    for k, mass in enumerate(masses):
        m.change(body, mass=mass)
        if many.reason[k] is not None:
            with pytest.raises(MechanismError) as raised:
                m.simulate(times=times, tolerance=tolerance)
            assert str(raised.value) in str(many.reason[k])
            continue
        sol = m.simulate(times=times, tolerance=tolerance)
        met.append(len(sol.events))
        assert many.alone[k] is None, many.way
        near = [m.simulate(times=times, tolerance=smaller * tolerance) for smaller in SMALLER]
        if any(np.abs(many[part][k] - there).max() > may for part, there, may in _allowed(sol, near, body, tolerance)):
            near += [
                _with(m, body, mass * (1.0 + part)).simulate(times=times, tolerance=tolerance) for part in ROUNDINGS
            ]
        for part, there, may in _allowed(sol, near, body, tolerance):
            np.testing.assert_allclose(many[part][k], there, rtol=0.0, atol=may, err_msg=part)
    return met


def _with(m: Mechanism, body: str, mass: float) -> Mechanism:
    m.change(body, mass=mass)
    return m


def _allowed(
    sol: Solution, near: Sequence[Solution], body: str, tolerance: float
) -> Iterator[tuple[str, np.ndarray, float]]:
    """Each part of a motion (T,), and by how much it may differ; ``near``: samples of the error."""
    for part in PARTS:
        there = getattr(sol.body(body), part)
        sample = max(float(np.abs(there - getattr(other.body(body), part)).max()) for other in near)
        yield part, there, EXACT + ERROR * sample + ROUNDED * tolerance * max(1.0, float(np.abs(there).max()))
