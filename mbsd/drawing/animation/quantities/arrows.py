"""Arrows and arcs over a clip: what they stand for, where they begin, how long they are in their own unit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mbsd.model.body import Marker
from mbsd.results.force_view import Action
from mbsd.results.solution import Solution
from mbsd.results.views import FrameView


@dataclass(frozen=True)
class Arrow:
    """A vector at a point that may move."""

    quantity: str
    """A word of ``show``."""
    place: np.ndarray
    """(T, 2) where it begins (m)."""
    vector: np.ndarray
    """(T, 2) in its own unit, world axes."""
    middle: bool = False
    """Whether ``place`` is its middle instead."""
    weight: bool = False
    """Whether it is the weight of a body, one of the forces."""

    @property
    def size(self) -> np.ndarray:
        """(T,)"""
        return np.hypot(*self.vector.T)


@dataclass(frozen=True)
class Arc:
    """A turning quantity about a point; positive counter-clockwise."""

    quantity: str
    place: np.ndarray
    """(T, 2) m."""
    value: np.ndarray
    """(T,) in its own unit."""

    @property
    def size(self) -> np.ndarray:
        """(T,)"""
        return np.abs(self.value)


@dataclass(frozen=True)
class Moving:
    """A marker along a motion, world axes, (T, 2) each."""

    place: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


def moving(view: FrameView, x: float, y: float) -> Moving:
    """The point (x, y) of a body whose frame moves like ``view`` (m)."""
    c, s = np.cos(view.theta), np.sin(view.theta)
    arm = np.stack([c * x - s * y, s * x + c * y], axis=1)
    across = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    omega, alpha = view.omega[:, None], view.alpha[:, None]
    return Moving(
        np.stack([view.x, view.y], axis=1) + arm,
        np.stack([view.vx, view.vy], axis=1) + omega * across,
        np.stack([view.ax, view.ay], axis=1) + alpha * across - omega**2 * arm,
    )


def applied(sol: Solution) -> Iterator[tuple[Action, np.ndarray]]:
    """Yield the action of each force on each moving body that it loads, and its place (T, 2) (m)."""
    for view in sol.forces.values():
        for body in view.bodies:
            if body != "ground":
                action = view.on(body)
                yield action, np.stack([action.x, action.y], axis=1)


def moving_marker(views: dict[str, FrameView], marker: Marker) -> Moving:
    """The origin of a marker."""
    return moving(views[marker.body.name], marker.x, marker.y)
