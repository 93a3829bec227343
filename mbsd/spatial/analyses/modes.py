"""Modes of a linearisation in space: eigenvalues of A, and how every body moves.

    lambda = -zeta omega +- i omega sqrt(1 - zeta^2)        omega = |lambda|

A pair of conjugate eigenvalues is one mode, and a real one a mode of its own; a free rigid motion has frequency 0. A
mode moves every body by Re(amplitude shape e^(lambda t)), scaled so that the largest displacement of a frame, or turn
times the mechanism's size, is 1 and real. Source: Meirovitch, Fundamentals of Vibrations, ch. 7.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from mbsd.analyses.modes import Mode
from mbsd.spatial.arrays.packing import Packed
from mbsd.spatial.model.rotation import rotation_matrix

__all__ = ["Linear", "Mode", "modes_of"]

REAL = 1e-9
"""Part of an eigenvalue or shape below which its imaginary part is rounding."""


class Linear(Protocol):
    """Linear state space from which modes follow; see :class:`mbsd.spatial.analyses.linearise.Linearisation`."""

    @property
    def a(self) -> np.ndarray:
        """(k, k)"""
        ...

    @property
    def deviations(self) -> np.ndarray:
        """(12 n, k)"""
        ...

    @property
    def rigid(self) -> int:
        """Free rigid motions, which come first."""
        ...

    @property
    def packed(self) -> Packed:
        """Arrays and names of the mechanism."""
        ...

    @property
    def q(self) -> np.ndarray:
        """The base pose."""
        ...


def modes_of(linear: Linear) -> tuple[Mode, ...]:
    """Return all modes by rising frequency: free rigid motions, then one for each pair or real eigenvalue."""
    free, half = 2 * linear.rigid, len(linear.deviations) // 2
    values, vectors = np.linalg.eig(linear.a[free:, free:])
    pairs = [(0.0 + 0.0j, linear.deviations[:half, k]) for k in range(linear.rigid)]
    for value, vector in zip(values, vectors.T, strict=True):
        if value.imag < -REAL * abs(value):
            continue
        # rigid entries follow: x_r'' = A_r x, so x_r = A_r x / lambda^2
        whole = np.zeros(len(linear.a), complex)
        whole[free:] = vector
        if linear.rigid and value != 0.0:
            drift = linear.a[linear.rigid : free, free:] @ vector
            whole[: linear.rigid] = drift / value**2
        pairs.append((complex(value), linear.deviations[:half] @ whole))
    pairs.sort(key=lambda mode: abs(mode[0]))
    return tuple(Mode(value, _shape(linear, way), {}) for value, way in pairs)


def _shape(linear: Linear, way: np.ndarray) -> dict[str, np.ndarray]:
    """Return place and rotation vector (6,) of each body's frame in a deviation (6 n,) of centres of mass."""
    packed, shape = linear.packed, dict[str, Any]()
    for b, body in enumerate(packed.bodies[1:], 1):
        moved = np.array(way[6 * b - 6 : 6 * b])
        turned = rotation_matrix(linear.q[7 * b - 1 : 7 * b + 3])
        arm = turned @ (body.principal[1].T @ -np.array(body.com))
        moved[:3] += np.cross(moved[3:], arm)
        shape[body.name] = moved
    sized = np.array([part / np.repeat([1.0, 1.0 / packed.size], 3) for part in shape.values()]).ravel()
    largest = sized[int(np.argmax(np.abs(sized)))]
    out = {name: part / largest for name, part in shape.items()} if largest != 0.0 else shape
    return {name: part.real if np.abs(part.imag).max(initial=0.0) < REAL else part for name, part in out.items()}
