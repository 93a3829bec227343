"""A planar mechanism of pins as plain data, the same for every code.

Body frames are at the centres of mass. SI units.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

GROUND = -1
Point = tuple[float, float]


@dataclass(frozen=True)
class Solid:
    """Mass (kg), inertia about the centre of mass (kg m^2), pose (x, y, angle) and velocity at the start."""

    mass: float
    inertia: float
    pose: tuple[float, float, float]
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Pin:
    """Point ``a`` of body ``i`` and point ``b`` of body ``j`` are one; body -1 is the ground."""

    i: int
    a: Point
    j: int
    b: Point


@dataclass(frozen=True)
class Spring:
    """A linear spring between two points, ``stiffness`` N/m, free ``length`` m."""

    i: int
    a: Point
    j: int
    b: Point
    stiffness: float
    length: float


@dataclass(frozen=True)
class Pinned:
    """Bodies, pins, downward gravity (m/s^2), torques on bodies (N m, world) and springs."""

    solids: tuple[Solid, ...]
    pins: tuple[Pin, ...]
    gravity: float = 0.0
    torques: tuple[tuple[int, float], ...] = ()
    springs: tuple[Spring, ...] = ()

    @property
    def start(self) -> tuple[np.ndarray, np.ndarray]:
        """Poses and velocities at the start, each (bodies, 3)."""
        return np.array([s.pose for s in self.solids]), np.array([s.velocity for s in self.solids])


@dataclass(frozen=True)
class Record:
    """Motion computed by a code: times (n,), poses and velocities of all centres of mass (n, bodies, 3)."""

    times: np.ndarray
    poses: np.ndarray
    velocities: np.ndarray


def energy(model: Pinned, poses: np.ndarray, velocities: np.ndarray) -> np.ndarray:
    """Kinetic energy and that of gravity, J; poses and velocities (..., bodies, 3)."""
    mass = np.array([s.mass for s in model.solids])
    inertia = np.array([s.inertia for s in model.solids])
    speed2 = velocities[..., 0] ** 2 + velocities[..., 1] ** 2
    parts = 0.5 * mass * speed2 + 0.5 * inertia * velocities[..., 2] ** 2 + model.gravity * mass * poses[..., 1]
    return parts.sum(-1)


def energy_drift(model: Pinned, record: Record) -> float:
    """Return the largest difference of the energy from that of the exact start (J).

    It is infinite if the record holds no numbers.
    """
    drift = np.abs(energy(model, record.poses, record.velocities) - energy(model, *model.start))
    worst = float(drift.max())
    return worst if np.isfinite(worst) else float("inf")


def closure(model: Pinned) -> float:
    """How far the pins are open at the start, m."""
    return max(float(np.hypot(*(_place(model, p.i, p.a) - _place(model, p.j, p.b)))) for p in model.pins)


def _place(model: Pinned, body: int, point: Point) -> np.ndarray:
    if body == GROUND:
        return np.array(point)
    x, y, angle = model.solids[body].pose
    c, s = np.cos(angle), np.sin(angle)
    return np.array([x + c * point[0] - s * point[1], y + s * point[0] + c * point[1]])


def spanning_tree(model: Pinned) -> tuple[dict[int, tuple[int, Pin]], list[Pin]]:
    """Return the parent and pin of each body, parents first, and the pins that close loops."""
    parents: dict[int, tuple[int, Pin]] = {}
    waiting = list(model.pins)
    reached = [GROUND]
    for body in reached:
        for pin in list(waiting):
            if body not in (pin.i, pin.j):
                continue
            child = pin.j if body == pin.i else pin.i
            if child != GROUND and child not in parents:
                parents[child] = body, pin
                reached.append(child)
                waiting.remove(pin)
    return parents, waiting
