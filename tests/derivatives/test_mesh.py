"""Nodes of tangents, and the collocation along them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mbsd.derivatives.free.explicit_time import find_toggles, stencil_at
from mbsd.derivatives.free.linear_motion import NODES, PLACES, carried, own_rates
from mbsd.derivatives.free.mesh import first_edges, longest_steps, looked_at, nodes_of, refined


def turning(steps: int) -> tuple[float, float, float, float]:
    """Largest errors of a loaded oscillator at ends of steps and inside, and estimates of both; in steps of 3 s."""
    edges = np.linspace(0.0, 3.0, steps + 1)
    t = np.append((edges[:-1, None] + np.diff(edges)[:, None] * PLACES[:NODES]).ravel(), 3.0)
    a = np.broadcast_to(np.array([[-25.0, 0.0]]), (len(t), 1, 2))
    b = np.zeros((len(t), 1, 1))
    b[:, 0, 0] = 24.0 * np.cos(t)  # x = cos(t) + cos(5 t)
    line = carried(t, a, b, np.array([[2.0], [0.0]]), np.full((2, 1), 1e-9))
    assert line.errors.shape == (steps, 3)
    assert np.allclose(line.at(t), line.y, rtol=0.0, atol=1e-13)
    times = np.linspace(0.0, 3.0, 200)
    ends, inside = (
        np.abs(y[:, 0, 0] - np.cos(at) - np.cos(5 * at)).max()
        for y, at in ((line.y[::NODES], edges), (line.at(times), times))
    )
    return float(ends), float(inside), float(line.errors[:, 0].sum()), float(line.errors[:, 1].max())


def test_collocation_is_of_order_16_at_ends_of_10_inside_and_knows_its_error() -> None:
    (coarse, inside, added, left), (fine, finer, *_) = turning(3), turning(6)
    assert 14.0 < np.log2(coarse / fine) < 18.0
    assert 9.0 < np.log2(inside / finer) < 11.0
    assert coarse < added < 50.0 * inside
    assert inside < 2.0 * left < 50.0 * inside  # the largest y is 2


def test_errors_are_parts_of_what_has_grown_so_far() -> None:
    edges = np.linspace(0.0, 20.0, 21)
    t = np.append((edges[:-1, None] + np.diff(edges)[:, None] * PLACES[:NODES]).ravel(), 20.0)
    a = np.broadcast_to(np.array([[1.0, 0.0]]), (len(t), 1, 2))  # x'' = x: from 1 to exp(20)
    line = carried(t, a, np.zeros((len(t), 1, 1)), np.ones((2, 1)), np.full((2, 1), 1e-9))
    assert np.allclose(line.errors, line.errors[0], rtol=1e-3)
    assert (line.errors[:, :2] > 0.0).all()


def kink(t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A = [-2 + 6 z^2, 0] along z = tanh(t), which solves z'' = 2 z^3 - 2 z, with its rates u and others that solve it.

    The other solution of y' = A y is y = z' int dt / z'^2.
    """
    z, slope = np.tanh(t), 1.0 / np.cosh(t) ** 2
    u = np.stack([slope, -2.0 * z * slope], axis=1)
    area = 0.375 * t + np.sinh(2.0 * t) / 4.0 + np.sinh(4.0 * t) / 32.0  # of cosh^4
    other = np.stack([slope * area, u[:, 1] * area + 1.0 / slope], axis=1)
    return np.stack([-2.0 + 6.0 * z * z, 0.0 * t], axis=1)[:, None], u, other


def test_rates_of_the_motion_itself_take_errors_of_steps_from_its_changes() -> None:
    edges = np.linspace(-4.0, 4.0, 9)
    t = np.append((edges[:-1, None] + np.diff(edges)[:, None] * PLACES[:NODES]).ravel(), 4.0)
    a, u, other = kink(t)
    b, slight = np.zeros((len(t), 1, 2)), np.full((2, 2), 1e-12)
    for part in (0.0, 1e-6):  # by which the equations are off, as along a motion that is not quite one
        begun = np.stack([3.0 * u[0], 3.0 * u[0] + other[0]], axis=1)
        plain = carried(t, a * (1.0 + part), b, begun, slight)
        line = carried(t, a * (1.0 + part), b, begun, slight, flow=u)
        right = np.stack([3.0 * u, 3.0 * u + other], axis=2)
        error = np.abs(line.y - right).max(axis=(0, 1)), np.abs(plain.y - right).max(axis=(0, 1))
        assert error[0][0] < 1e-13
        assert error[1][0] > 1e-8
        assert not plain.errors[:, 2].any()
        assert 0.0 < np.linalg.norm(line.errors[:, 2]) < 1e-3
        assert np.allclose(line.at(t[::NODES]), line.y[::NODES], rtol=1e-12, atol=1e-12)


def test_a_motion_that_is_rounding_corrects_nothing() -> None:
    t = np.append((np.arange(3.0)[:, None] + PLACES[:NODES]).ravel(), 3.0)
    a, b, slight = np.full((len(t), 1, 2), -1.0), np.zeros((len(t), 1, 1)), np.full((2, 1), 1e-9)
    noise = np.random.default_rng(1).normal(0.0, 1e-17, (len(t), 2))
    plain = carried(t, a, b, np.ones((2, 1)), slight)
    assert (carried(t, a, b, np.ones((2, 1)), slight, flow=noise).y == plain.y).all()


def test_coupled_equations_are_those_of_an_integrator() -> None:
    random = np.random.default_rng(3)
    constant, turning_part = random.normal(0.0, 8.0, (2, 3, 6))
    push, begun = random.normal(0.0, 1.0, (3, 2)), random.normal(0.0, 1.0, (6, 2))

    def matrix(t: float) -> np.ndarray:
        return constant + np.sin(3.0 * t) * turning_part

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        s = y.reshape(6, 2)
        return np.concatenate([s[3:], matrix(t) @ s + np.cos(t) * push]).ravel()

    edges = np.linspace(0.0, 1.0, 7)
    t = np.append((edges[:-1, None] + np.diff(edges)[:, None] * PLACES[:NODES]).ravel(), 1.0)
    line = carried(t, np.array([matrix(at) for at in t]), np.cos(t)[:, None, None] * push, begun, np.full((6, 2), 1e-9))
    truth = solve_ivp(rates, (0.0, 1.0), begun.ravel(), "DOP853", t, rtol=1e-13, atol=1e-13)
    known = truth.y.T.reshape(len(t), 6, 2)
    assert np.allclose(line.y[::NODES], known[::NODES], rtol=0.0, atol=1e-9 * np.abs(known).max())
    assert np.allclose(line.rates[0], rates(0.0, begun.ravel()).reshape(6, 2), rtol=1e-12, atol=1e-12)


def test_coordinates_may_have_rates_of_their_own_and_more_of_them_than_velocities() -> None:
    random = np.random.default_rng(5)
    constant, turning_part = random.normal(0.0, 3.0, (2, 5, 5))  # n = 3 coordinates, k = 2 velocities
    push, begun = random.normal(0.0, 1.0, (2, 5, 2))

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        return ((constant + np.sin(3.0 * t) * turning_part) @ y.reshape(5, 2) + np.cos(t) * push).ravel()

    edges = np.linspace(0.0, 1.0, 7)
    t = np.append((edges[:-1, None] + np.diff(edges)[:, None] * PLACES[:NODES]).ravel(), 1.0)
    matrix = constant + np.sin(3.0 * t)[:, None, None] * turning_part
    right = np.cos(t)[:, None, None] * push
    slight = np.full((5, 2), 1e-9)
    line = carried(t, matrix[:, 3:], right[:, 3:], begun, slight, own_rates(matrix[:, :3], right[:, :3]))
    truth = solve_ivp(rates, (0.0, 1.0), begun.ravel(), "DOP853", t, rtol=1e-13, atol=1e-13)
    known = truth.y.T.reshape(len(t), 5, 2)
    assert np.allclose(line.y[::NODES], known[::NODES], rtol=0.0, atol=1e-9 * np.abs(known).max())
    assert np.allclose(line.rates[-1], rates(1.0, line.y[-1].ravel()).reshape(5, 2), rtol=1e-12, atol=1e-9)


def test_rates_that_are_velocities_are_a_case_of_rates_of_their_own() -> None:
    random = np.random.default_rng(7)
    t = np.append((np.linspace(0.0, 1.0, 5)[:-1, None] + 0.25 * PLACES[:NODES]).ravel(), 1.0)
    a, b = random.normal(0.0, 3.0, (len(t), 2, 4)), random.normal(0.0, 1.0, (len(t), 2, 3))
    begun, slight = random.normal(0.0, 1.0, (4, 3)), np.full((4, 3), 1e-9)
    same = np.broadcast_to(np.eye(4)[2:], (len(t), 2, 4))
    own = carried(t, a, b, begun, slight, own_rates(same, np.zeros_like(b)))
    assert np.allclose(own.y, carried(t, a, b, begun, slight).y, rtol=1e-10, atol=1e-12)


def test_steps_are_longer_where_the_motion_is_smooth_wherever_outputs_are() -> None:
    t = np.linspace(0.0, 1.0, 41)
    motion = np.sin(2 * np.pi * t)[:, None] + np.exp(-(((t - 0.7) / 0.01) ** 2))[:, None]
    longest = longest_steps(t, motion, np.full(motion.shape[1], 1.0 / np.abs(motion).max()), 0.05)
    assert longest.shape == (40,)
    assert (longest[:20] > 0.08).all()
    assert longest[27] < 0.04
    edges = first_edges((0.0, 1.0), np.zeros(0), t, longest)
    gaps = np.diff(edges)
    assert gaps[edges[:-1] < 0.4].max() > 0.08
    assert len(looked_at(t)) > 3 * len(t)
    assert np.isin(t, looked_at(t)).all()
    assert gaps[(edges[:-1] > 0.68) & (edges[:-1] < 0.72)].max() < 0.04
    nodes = nodes_of(edges, np.zeros(0))
    assert len(nodes) == NODES * len(gaps) + 1


def test_an_event_is_an_edge_and_steps_come_closer_where_errors_are() -> None:
    t, met = np.linspace(0.0, 1.0, 11), np.array([0.234])
    edges = first_edges((0.0, 1.0), met, t, np.full(10, 0.2))
    assert 0.234 in edges
    finer = refined(np.array([0.0, 1.0, 2.0]), np.array([[1e-9, 1e-6, 0.0], [1e-3, 1e-6, 0.0]]), 1e-5)
    assert finer.tolist() == [0.0, 1.0, 1.25, 1.5, 1.75, 2.0]
    finer = refined(np.array([0.0, 1.0, 2.0]), np.array([[1e-9, 9e-6, 7e-6], [1e-9, 1.1e-5, 0.0]]), 1e-5)
    assert finer.tolist() == [0.0, 1.0, 1.5, 2.0]
    finer = refined(np.array([0.0, 1.0, 2.0]), np.array([[1e-9, 9e-6, 8e-6], [1e-9, 9e-6, 0.0]]), 1e-5)
    assert finer.tolist() == [0.0, 0.5, 1.0, 2.0]


@pytest.mark.parametrize("scale", [1.0, 1e-4, 1e-7])
def test_stencil_at_nodes_tell_slopes_from_within_the_stretch(scale: float) -> None:
    """Derivatives by time at nodes agree for steps that are ``scale`` s long, a while after 0."""
    t = 0.3 + scale * (np.arange(3)[:, None] + PLACES[None, :-1]).ravel()
    t = np.append(t, 0.3 + 3.0 * scale)
    stencil = stencil_at(t, t, np.ones(len(t), bool))
    assert (stencil.times >= t[0]).all()
    assert (stencil.times <= t[-1]).all()
    slope = (stencil.weights * np.sin((stencil.times - 0.3) / scale)).sum(axis=0) * scale
    assert np.allclose(slope, np.cos((t - 0.3) / scale), rtol=0.0, atol=max(1e-6, 1e-16 / scale * 1e3))


def test_toggles_are_where_accelerations_are_sudden() -> None:
    t = np.concatenate([np.linspace(0.0, 0.499, 100), np.linspace(0.4999, 0.5001, 21), np.linspace(0.501, 1.0, 100)])
    a = np.sin(t)[:, None] * [1.0, 2.0]
    assert not find_toggles(t, a).any()
    a[110, 1] = 1e4
    assert find_toggles(t, a).nonzero()[0].tolist() == [110]
