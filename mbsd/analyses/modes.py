"""Modes of a linearisation: eigenvalues of A, and how every body moves.

    lambda = -zeta omega +- i omega sqrt(1 - zeta^2)        omega = |lambda|

A pair of conjugate eigenvalues is one mode. A real eigenvalue is a mode of its own that creeps (zeta = 1) or runs away
(zeta = -1); a pair of zeros is one motion without resistance, at frequency 0. A mode moves every body by

    Re(amplitude shape e^(lambda t)),        shape: x, y, theta of the body's frame

scaled so that the largest displacement of a frame, or turn times the mechanism's size, is 1 and real.
Source: Meirovitch, Fundamentals of Vibrations, ch. 7.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from mbsd.arrays.inertias import connected
from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting, no_such


class Linear(Protocol):
    """Linear state space from which modes follow; see :class:`mbsd.analyses.state_space.Linearisation`."""

    @property
    def model(self) -> Any:
        """The mechanism."""
        ...

    @property
    def a(self) -> np.ndarray:
        """(2 f + s, 2 f + s) z', z'' and s' by z, z' and s; s: states of forces."""
        ...

    @property
    def c(self) -> np.ndarray:
        """(3 nb, f) change of all coordinates by the independent ones."""
        ...

    @property
    def q(self) -> np.ndarray:
        """The pose."""
        ...

    @property
    def com(self) -> np.ndarray:
        """(nb, 2) m."""
        ...

    @property
    def size(self) -> float:
        """Size of the mechanism (m)."""
        ...

    @property
    def coordinates(self) -> Any:
        """Names of the f independent coordinates."""
        ...


ZERO = 1e-10
"""Squares of eigenvalues below this part of the largest stiffness over mass are zero."""


@dataclass(frozen=True, eq=False)
class Mode(Suggesting):
    """One mode."""

    eigenvalue: complex
    """1/s, the one with positive imaginary part of a pair."""
    shape: dict[str, np.ndarray]
    """(3,) x, y (m), theta (rad) of each body's frame; real if all bodies move in step, else complex."""
    coordinates: dict[str, complex]
    """The same of the independent coordinates."""

    @property
    def omega(self) -> float:
        """Natural frequency (rad/s): |lambda|."""
        return abs(self.eigenvalue)

    @property
    def frequency(self) -> float:
        """Natural frequency (Hz)."""
        return self.omega / (2 * math.pi)

    @property
    def damped_frequency(self) -> float:
        """Frequency at which it swings (Hz); 0 if it does not."""
        return abs(self.eigenvalue.imag) / (2 * math.pi)

    @property
    def damping_ratio(self) -> float:
        """zeta: 0 undamped, 1 and more creeps back, negative grows."""
        return -self.eigenvalue.real / self.omega if self.omega else 0.0

    def of(self, body: str) -> np.ndarray:
        """(3,) shape of one body. Raises ModelError for a body that is not there."""
        if body not in self.shape:
            raise ModelError(no_such("body", body, self.shape))
        return self.shape[body]

    def __str__(self) -> str:
        return (
            f"{self.frequency:.6g} Hz, {self.omega:.6g} rad/s, damping ratio {self.damping_ratio:.4g}, "
            f"largest in {max(self.shape, key=lambda name: float(np.abs(self.shape[name]).max()))}"
        )


def modes_of(linear: Linear) -> tuple[Mode, ...]:
    """All modes, by rising frequency; one for each pair of eigenvalues, one for each real eigenvalue.

    Coordinates that do not pull at each other have modes of their own, so that none is measured by others' stiffness.
    """
    f = len(linear.coordinates)
    free: list[np.ndarray] = []
    moving: list[tuple[complex, np.ndarray]] = []
    for at in _groups(linear.a, f):
        whole = np.concatenate([at, f + at, np.arange(2 * f, len(linear.a))])
        still, own = _modes_among(linear.a[np.ix_(whole, whole)], len(at))
        free += [_spread(z, at, f) for z in still]
        moving += [(value, _spread(z, at, f)) for value, z in own]
    moving.sort(key=lambda mode: abs(mode[0]))
    return (*(_mode(linear, 0.0, z) for z in free), *(_mode(linear, value, z) for value, z in moving))


def _groups(a: np.ndarray, f: int) -> list[np.ndarray]:
    """Coordinates that pull at each other; all of them where there are states beside them."""
    if len(a) > 2 * f:
        return [np.arange(f)]
    pairs = np.argwhere((a[f:, :f] != 0.0) | (a[f:, f:] != 0.0)) + 1
    group = connected(pairs, f + 1)[1:]
    return [np.flatnonzero(group == number) for number in np.unique(group)]


def _spread(z: np.ndarray, at: np.ndarray, f: int) -> np.ndarray:
    out = np.zeros(f, z.dtype)
    out[at] = z
    return out


def _modes_among(a: np.ndarray, f: int) -> tuple[np.ndarray, list[tuple[complex, np.ndarray]]]:
    """Return (k, f) displacements that nothing pulls back, and the other eigenvalues with shapes (f,)."""
    values, vectors = np.linalg.eig(a)
    pull, slow = a[f : 2 * f, :f], a[f : 2 * f, f : 2 * f]
    largest = float(np.abs(pull).max()) + float(np.abs(slow).max()) ** 2
    if len(values) > 2 * f:  # states are large beside places, and what they do to these is none of the two
        largest = float(np.abs(values).max()) ** 2
        size = np.abs(vectors[:f]).max(axis=0)
        vectors = np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0.0)
    values = np.where(np.abs(values) ** 2 <= ZERO * largest, 0.0, values)
    straight = np.abs(values.imag) <= 1e-9 * np.abs(values)
    values = np.where(straight, values.real, values)
    chosen = [k for k in np.argsort(np.abs(values), kind="stable") if values[k].imag >= 0.0 and values[k] != 0.0]
    return _free(pull), [(complex(values[k]), vectors[:f, k]) for k in chosen if vectors[:f, k].any()]


def _free(pull: np.ndarray) -> np.ndarray:
    """(free motions, f) displacements that nothing pulls back."""
    _, singular, right = np.linalg.svd(pull)
    return right[singular <= ZERO * singular.max(initial=0.0)]


def _mode(linear: Linear, value: complex, z: np.ndarray) -> Mode:
    every = (linear.c @ z).reshape(-1, 3)
    c, s = np.cos(linear.q[2::3]), np.sin(linear.q[2::3])
    arm_x = c * linear.com[:, 0] - s * linear.com[:, 1]
    arm_y = s * linear.com[:, 0] + c * linear.com[:, 1]
    every[:, 0] += arm_y * every[:, 2]
    every[:, 1] -= arm_x * every[:, 2]
    size = np.array([1.0, 1.0, linear.size])
    largest = np.argmax(np.abs(every * size).round(9))
    scale = (every * size).ravel()[largest]
    every, z = every / scale, z / scale
    every[np.abs(every * size) < 1e-12] = 0.0
    if np.abs(every.imag).max() <= 1e-6 * np.abs(every).max():
        every = every.real.copy()
        z = z.real.copy()
    names = list(linear.model.bodies)
    shape = {name: every[b] for b, name in enumerate(names) if b > 0}
    return Mode(value, shape, dict(zip(linear.coordinates, z.tolist(), strict=True)))
