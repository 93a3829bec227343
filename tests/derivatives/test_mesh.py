"""Nodes of tangents, and the collocation along them."""

from __future__ import annotations

import numpy as np

from mbsd.derivatives.linear_motion import NODES, PLACES, carried
from mbsd.derivatives.mesh import first_edges, longest_steps, looked_at, nodes_of, refined


def turning(steps: int) -> tuple[float, float]:
    """Largest error of an oscillator with a load at ends of steps, and the estimate; in so many steps of 3 s."""
    edges = np.linspace(0.0, 3.0, steps + 1)
    t = np.append((edges[:-1, None] + np.diff(edges)[:, None] * PLACES[:NODES]).ravel(), 3.0)
    a = np.broadcast_to(np.array([[0.0, 1.0], [-25.0, 0.0]]), (len(t), 2, 2))
    b = np.zeros((len(t), 2, 1))
    b[:, 1, 0] = 24.0 * np.cos(t)  # x = cos(t) + cos(5 t)
    y, errors = carried(t, a, b, np.array([[2.0], [0.0]]), np.full((2, 1), 1e-9))
    assert errors.shape == (steps,)
    return float(np.abs(y[::NODES, 0, 0] - np.cos(edges) - np.cos(5 * edges)).max()), float(errors.sum())


def test_collocation_is_of_eighth_order_and_knows_its_error() -> None:
    (coarse, estimate), (fine, _) = turning(10), turning(20)
    assert 7.5 < np.log2(coarse / fine) < 8.5
    assert 0.02 * coarse < estimate < 50.0 * coarse


def test_steps_are_longer_where_the_motion_is_smooth_and_outputs_are_nodes() -> None:
    t = np.linspace(0.0, 1.0, 41)
    motion = np.sin(2 * np.pi * t)[:, None] + np.exp(-(((t - 0.7) / 0.01) ** 2))[:, None]
    longest = longest_steps(t, motion / np.abs(motion).max(), 0.02)
    assert longest.shape == (40,)
    assert (longest[:20] > 0.03).all()
    assert longest[27] < 0.02
    edges = first_edges(t, np.zeros(0), t, longest)
    gaps = np.diff(edges)
    assert gaps[edges[:-1] < 0.4].max() > 0.024
    assert len(looked_at(t)) > 3 * len(t)
    assert np.isin(t, looked_at(t)).all()
    assert gaps[(edges[:-1] > 0.68) & (edges[:-1] < 0.72)].max() < 0.02
    nodes = nodes_of(edges, t, np.zeros(0))
    assert len(nodes) == NODES * len(gaps) + 1
    assert np.isin(t, nodes).all()


def test_an_event_is_an_edge_and_steps_come_closer_where_errors_are() -> None:
    t, met = np.linspace(0.0, 1.0, 11), np.array([0.234])
    edges = first_edges(t, met, t, np.full(10, 0.2))
    assert 0.234 in edges
    finer = refined(np.array([0.0, 1.0, 2.0]), np.array([1e-9, 1e-3]), 1e-5)
    assert finer.tolist() == [0.0, 1.0, 1.25, 1.5, 1.75, 2.0]
