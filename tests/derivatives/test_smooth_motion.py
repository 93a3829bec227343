"""A smooth motion between looks at it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import Polynomial

import mbsd
from mbsd.derivatives import simulations
from mbsd.derivatives.free.mesh import looked_at_closer
from mbsd.derivatives.smooth.between_looks import between_looks
from mbsd.dynamics.repeated import Repeated
from mbsd.measures import final
from mbsd.numbers.names import number_named, with_values

COEFFICIENT = st.floats(-1.0, 1.0)


@given(
    st.lists(COEFFICIENT, min_size=9, max_size=9),
    st.lists(st.floats(0.05, 1.0), min_size=2, max_size=6),
    st.floats(0.0, 1.0),
)
def test_polynomials_of_degree_8_are_themselves(coefficients: list[float], gaps: list[float], part: float) -> None:
    t = np.concatenate([[0.0], np.cumsum(gaps)])
    t /= t[-1]
    line = Polynomial(coefficients)
    looks = [np.stack([line.deriv(k)(t), line.deriv(k)(t) * 2.0], axis=1) for k in range(3)]
    times = np.array([part, t[1]])
    for k, value in enumerate(between_looks(t, *looks, times)):
        assert np.allclose(value[:, 0], line.deriv(k)(times), rtol=0.0, atol=1e-7)
        assert np.allclose(value[:, 1], 2.0 * value[:, 0], rtol=0.0, atol=1e-7)
    for value, look in zip(between_looks(t, *looks, t), looks, strict=True):
        assert np.allclose(value, look, rtol=0.0, atol=1e-7)


def test_closer_looks_keep_the_first_ones() -> None:
    t = np.array([0.0, 1.0, 3.0])
    closer = looked_at_closer(t, np.array([100.0, 8.0]))
    assert closer.tolist() == [0.0, 1.0, 1.5, 2.0, 2.5, 3.0]


def settling() -> mbsd.Mechanism:
    """A fast swing that damping slows down: its steps grow by far."""
    m = mbsd.Mechanism("settling")
    rod = m.bar("rod", 0.1, mass=0.2)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.torsion_spring("oil", m.ground, rod, stiffness=0.02, damping=2e-4)
    m.start_near(rod=20)
    m.start_moving(rod=60.0)
    return m


def softly_landing() -> mbsd.Mechanism:
    """A rod whose wheel falls on the floor, which pushes with a kink."""
    m = mbsd.Mechanism("landing")
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("A", m.ground.at(0, 0.3), rod.start)
    m.contact("pad", m.ground.at(0, 0), rod.end, 3e5, damping=20.0, radius=0.02)
    m.start_near(rod=0)
    return m


def difference(m: mbsd.Mechanism, name: str, duration: float, measure: mbsd.measures.Measure, h: float) -> float:
    """By central differences of whole simulations."""
    number, ends = number_named(m, name), []
    for value in (number.value + h, number.value - h):
        sol = with_values(m, [number], [value]).simulate(duration, steps=40, tolerance=1e-12)
        ends.append(float(sol.body("rod").theta[-1]))
    return (ends[0] - ends[1]) / (2 * h)


@pytest.mark.parametrize(("make", "name"), [(settling, "oil.stiffness"), (softly_landing, "pad.stiffness")])
def test_derivatives_of_motions_that_change_their_pace_are_those_of_differences(make: object, name: str) -> None:
    m = make()  # pyright: ignore[reportCallIssue]
    measure = final("rod.theta")
    made = m.sensitivities({"of": measure}, [name], 6.0 if make is settling else 0.8, 40)
    h = 1e-4 * number_named(m, name).value
    expected = difference(m, name, float(made.t[-1]), measure, h)
    assert made.of("of", name) == pytest.approx(expected, rel=2e-4)
    assert np.allclose(made.solution.q, m.simulate(float(made.t[-1]), steps=40, tolerance=1e-9).q, rtol=0, atol=1e-13)


def test_a_smooth_motion_is_not_simulated_at_its_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(self: Repeated, times: np.ndarray) -> None:
        raise AssertionError(f"simulated at {len(times)} nodes")

    turns: list[int] = []
    made = simulations.nodes_of

    def counted(edges: np.ndarray, met: np.ndarray) -> np.ndarray:
        turns.append(len(edges))
        return made(edges, met)

    monkeypatch.setattr(Repeated, "__call__", refuse)
    monkeypatch.setattr(simulations, "nodes_of", counted)
    settling().sensitivities({"of": final("rod.theta")}, ["oil.stiffness"], 6.0, 40)
    assert len(turns) == 1, turns
