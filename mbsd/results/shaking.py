"""Shaking forces on the frame by the inertia of the moving bodies, and their centre of mass.

    F  = -sum m a                                  shaking force (N), a of the centres of mass
    M  = -sum [(r - r0) x m a + I alpha]           shaking moment (N m) about r0
    Mx =  sum [(z - z0) m a_y + s_y]               couples (N m) about axes along x and y through z0, of bodies in
    My = -sum [(z - z0) m a_x + s_x]               different places z along the normal of the plane
    s  = alpha k x P - omega^2 P                   P = (int x z dm, int y z dm), products of inertia of a body

Source: Norton, Design of Machinery, ch. 12 and 13 (balancing; engine dynamics); for P: Maass, Klier 1981, ch. 3.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting
from mbsd.model.body import Body
from mbsd.results.views import Wrench


@dataclass(frozen=True)
class Shaking(Wrench):
    """Force (N) and moment (N m, about ``x``, ``y``) of all bodies' inertia on the frame, (T,) arrays."""

    mx: np.ndarray
    """(T,) couple about the x axis (N m), of bodies in different places z."""
    my: np.ndarray
    """(T,) couple about the y axis (N m)."""
    z: float = 0.0
    """Place along the normal of the plane about which the couples are (m)."""

    @property
    def moment(self) -> np.ndarray:
        """(T,) about (x, y) (N m)."""
        return self.torque

    @property
    def couple(self) -> np.ndarray:
        """(T, 2) mx and my (N m)."""
        return np.stack([self.mx, self.my], axis=-1)


@dataclass(frozen=True)
class Planes:
    """Places of moving bodies along the normal: (nb,) z (m), (nb, 2) products of inertia (kg m^2)."""

    z: np.ndarray
    products: np.ndarray

    @property
    def is_one(self) -> bool:
        """True if all bodies lie in z = 0, so that no couple arises."""
        return not (self.z.any() or self.products.any())

    @property
    def middle(self) -> float:
        """Halfway between the outermost bodies (m)."""
        return float(self.z.min() + self.z.max()) / 2 if len(self.z) else 0.0

    @property
    def reach(self) -> float:
        """How far the outermost bodies are apart (m)."""
        return float(np.ptp(self.z)) if len(self.z) else 0.0


def planes_of(bodies: Iterable[Body]) -> Planes:
    """As the bodies, ground left out, say now; a place that was not given is 0."""
    rows = [(body.z or 0.0, *body.products) for body in bodies if body.name != "ground"]
    table = np.array(rows).reshape(-1, 3)
    return Planes(table[:, 0], table[:, 1:])


@dataclass(frozen=True)
class PointView(Suggesting):
    """Motion of a point: (T,) arrays, m, m/s, m/s^2."""

    x: np.ndarray
    y: np.ndarray
    vx: np.ndarray
    vy: np.ndarray
    ax: np.ndarray
    ay: np.ndarray


def shaking(
    packed: Packed, planes: Planes, q: np.ndarray, v: np.ndarray, a: np.ndarray, about: tuple[float, float, float]
) -> Shaking:
    """Return shaking forces from (T, nb, 3) motions of centres of mass, about (x, y, z) on ground (m)."""
    mass, inertia = packed.system.mass[1:], packed.system.inertia[1:]
    push = -mass[:, None] * a[:, 1:, :2]
    arm = q[:, 1:, :2] - np.asarray(about[:2])
    moment = (arm[..., 0] * push[..., 1] - arm[..., 1] * push[..., 0] - inertia * a[:, 1:, 2]).sum(axis=1)
    fx, fy = push.sum(axis=1).T
    sx, sy = _first_moments(planes, push, about[2], q[:, 1:, 2], v[:, 1:, 2], a[:, 1:, 2])
    x, y = (np.full(len(q), at) for at in about[:2])
    return Shaking(x, y, fx, fy, moment, -sy, sx, about[2])


def _first_moments(
    planes: Planes, push: np.ndarray, z0: float, theta: np.ndarray, omega: np.ndarray, alpha: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(T,) each: integrals of z - z0 times the forces of inertia along x and y."""
    along = np.einsum("tbk,b->kt", push, planes.z - z0)
    c, s = np.cos(theta), np.sin(theta)
    px0, py0 = planes.products.T
    px, py = c * px0 - s * py0, s * px0 + c * py0
    return (
        along[0] + (alpha * py + omega**2 * px).sum(axis=1),
        along[1] + (omega**2 * py - alpha * px).sum(axis=1),
    )


def centre_of_mass(packed: Packed, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> PointView:
    """Return the centre of mass of all moving bodies, from (T, nb, 3). Raises ModelError without mass."""
    mass = packed.system.mass[1:]
    if not mass.sum() > 0:
        raise ModelError(f"{packed.name}: no body has mass, so there is no centre of mass; give masses to the bodies")
    weights = mass / mass.sum()
    x, y, vx, vy, ax, ay = (part[:, 1:, axis] @ weights for part in (q, v, a) for axis in (0, 1))
    return PointView(x, y, vx, vy, ax, ay)
