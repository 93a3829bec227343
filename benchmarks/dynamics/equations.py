"""Equations of a mechanism of pins in numpy, as experts write them, for scipy and SUNDIALS.

Reference coordinates q = (x, y, theta) of every body. M is diagonal, so the multipliers come from

    (J M^-1 J^T) lam = J M^-1 Q - gamma,    a = M^-1 (Q - J^T lam),

a small symmetric system, solved by LAPACK's Cholesky: dense, or in band form along a chain, where only the pins of one
body touch one another. Positions and velocities are projected with the same matrix. Points are complex numbers, and all
sums over pins are vectorised.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from benchmarks.dynamics.pins import GROUND, Pinned

LONG_CHAIN = 15
"""Above this many pins the band pays."""


class SingularPose(Exception):
    """J M^-1 J^T is not positive definite to working precision."""


def equations(model: Pinned) -> Equations:
    """In the form that is fastest for the model."""
    return Chain(model) if len(model.pins) > LONG_CHAIN else Equations(model)


class Equations:
    """Equations of one mechanism, dense.

    Flat q and v have the length ``size`` = 3 * bodies, constraints ``rows`` = 2 * pins.
    """

    def __init__(self, model: Pinned) -> None:
        count, pins = len(model.solids), len(model.pins)
        self.size, self.rows = 3 * count, 2 * pins
        mass = np.array([s.mass for s in model.solids])
        inertia = np.array([s.inertia for s in model.solids])
        self.mass = np.stack([mass, mass, inertia], axis=1).ravel()
        self.weight = 1 / self.mass
        self.load = np.zeros(self.size)
        self.load[1::3] = -model.gravity * mass
        for body, torque in model.torques:
            self.load[3 * body + 2] += torque
        self.springs = model.springs

        sides = [(k, p.j, p.b, 1.0) for k, p in enumerate(model.pins)]
        sides += [(k, p.i, p.a, -1.0) for k, p in enumerate(model.pins)]
        self.anchors = np.zeros(pins, complex)  # what the sides on the ground add to the residual
        for k, body, point, sign in sides:
            if body == GROUND:
                self.anchors[k] += sign * complex(*point)
        sides = [side for side in sides if side[1] != GROUND]
        self.pin = np.array([side[0] for side in sides])
        self.body = np.array([side[1] for side in sides])
        self.sign = np.array([side[3] for side in sides])
        self.local = np.array([complex(*side[2]) for side in sides]) * self.sign
        self.turn = 3 * self.body + 2
        self._plan()

    def _plan(self) -> None:
        sides = len(self.pin)
        self.gather = np.zeros((len(self.anchors), sides), complex)
        self.gather[self.pin, np.arange(sides)] = 1.0
        self.template = np.zeros((self.rows, self.size))
        self.template[2 * self.pin, 3 * self.body] = self.sign
        self.template[2 * self.pin + 1, 3 * self.body + 1] = self.sign
        turning = 2 * self.pin * self.size + self.turn
        self.spots = np.concatenate([turning, turning + self.size])

    def arms(self, q: np.ndarray) -> np.ndarray:
        """From each centre of mass to its side of a pin, in the world, signed: + of j, - of i."""
        return self.local * np.exp(1j * q[self.turn])

    def per_pin(self, of_sides: np.ndarray) -> np.ndarray:
        """Sums over the sides of each pin, as real rows x, y, x, y, ..."""
        return (self.gather @ of_sides).view(float)

    def residual(self, q: np.ndarray, arms: np.ndarray) -> np.ndarray:
        """Phi of all pins, j minus i."""
        middles = q[self.turn - 2] + 1j * q[self.turn - 1]
        return self.per_pin(self.sign * middles + arms) + self.anchors.view(float)

    def gamma(self, v: np.ndarray, arms: np.ndarray) -> np.ndarray:
        """J a = gamma: the centripetal part of each side."""
        return self.per_pin(v[self.turn] ** 2 * arms)

    def jacobian(self, arms: np.ndarray) -> np.ndarray:
        """J, dense."""
        out = self.template.copy()
        out.ravel()[self.spots] = np.concatenate([-arms.imag, arms.real])
        return out

    def loads(self, q: np.ndarray) -> np.ndarray:
        """Q: gravity, torques, springs (which hang on the ground)."""
        if not self.springs:
            return self.load
        out = self.load.copy()
        for s in self.springs:
            body = 3 * s.j
            x, y, angle = q[body : body + 3].tolist()
            arm = complex(*s.b) * np.exp(1j * angle)
            along = complex(x, y) + arm - complex(*s.a)
            pull = -s.stiffness * (1 - s.length / abs(along)) * along
            out[body] += pull.real
            out[body + 1] += pull.imag
            out[body + 2] += arm.real * pull.imag - arm.imag * pull.real
        return out

    def factor(self, arms: np.ndarray) -> tuple[np.ndarray, ...]:
        """J M^-1 J^T = L L^T, with J M^-1 and J for the products."""
        jac = self.jacobian(arms)
        weighted = jac * self.weight
        lower, info = lapack.dpotrf((weighted @ jac.T).T, lower=1, clean=0, overwrite_a=1)
        if info:
            raise SingularPose
        return lower, weighted, jac

    def times_jacobian(self, v: np.ndarray, factor: tuple[np.ndarray, ...]) -> np.ndarray:
        """J v."""
        return factor[2] @ v

    def correction(self, factor: tuple[np.ndarray, ...], right: np.ndarray) -> np.ndarray:
        """M^-1 J^T (J M^-1 J^T)^-1 right: the change, least by mass, of which J makes ``right``."""
        return lapack.dpotrs(factor[0], right, lower=1)[0] @ factor[1]

    def acceleration(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """The index-1 equations solved for a."""
        arms = self.arms(q)
        return self._acceleration(q, v, arms, self.factor(arms))

    def _acceleration(self, q: np.ndarray, v: np.ndarray, arms: np.ndarray, factor: tuple) -> np.ndarray:
        free = self.loads(q) * self.weight
        return free - self.correction(factor, self.times_jacobian(free, factor) - self.gamma(v, arms))

    def rates(self, _t: float, y: np.ndarray) -> np.ndarray:
        """Rates of y = (q, v), for an integrator."""
        v = y[self.size :]
        return np.concatenate([v, self.acceleration(y[: self.size], v)])

    def project(self, y: np.ndarray) -> np.ndarray:
        """The nearest position and velocity, measured by mass, that close the pins: one Newton step of each."""
        q, v, _, _ = self._projected(y)
        return np.concatenate([q, v])

    def projected_rates(self, _t: float, y: np.ndarray) -> np.ndarray:
        """The rates at the projected state: for multistep integrators, which must not be interrupted."""
        q, v, arms, factor = self._projected(y)
        return np.concatenate([v, self._acceleration(q, v, arms, factor)])

    def _projected(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, tuple]:
        q, v = y[: self.size], y[self.size :]
        arms = self.arms(q)
        q = q - self.correction(self.factor(arms), self.residual(q, arms))
        arms = self.arms(q)
        factor = self.factor(arms)
        return q, v - self.correction(factor, self.times_jacobian(v, factor)), arms, factor


class Chain(Equations):
    """The same with J M^-1 J^T in band form, and products with J written as sums."""

    def _plan(self) -> None:
        self.to_coordinates = np.concatenate([self.turn - 2, self.turn - 1, self.turn])
        sides = range(len(self.pin))
        pairs = np.array([(s, t) for s in sides for t in sides if self.body[s] == self.body[t]])
        self.first, self.second = pairs.T
        row = np.stack([2 * self.pin[self.first] + k for k in (0, 0, 1, 1)])
        column = np.stack([2 * self.pin[self.second] + k for k in (0, 1, 0, 1)])
        self.keep = row >= column  # the lower triangle, stored by columns as LAPACK takes it without a copy
        row, column = row[self.keep], column[self.keep]
        self.width = int((row - column).max()) + 1
        self.place = column * self.width + row - column
        turning = self.turn[self.first]
        self.by_mass = self.sign[self.first] * self.sign[self.second] * self.weight[turning - 2]
        self.by_inertia = self.weight[turning]

    def per_pin(self, of_sides: np.ndarray) -> np.ndarray:
        """Sums over the sides of each pin, as real rows x, y, x, y, ..."""
        out = np.empty((len(self.anchors), 2))
        out[:, 0] = np.bincount(self.pin, of_sides.real, len(out))
        out[:, 1] = np.bincount(self.pin, of_sides.imag, len(out))
        return out.ravel()

    def factor(self, arms: np.ndarray) -> tuple[np.ndarray, ...]:
        """J M^-1 J^T = L L^T in band form, and the arms for the products."""
        first, second = arms[self.first], arms[self.second]
        x, y = self.by_inertia * first.real, self.by_inertia * first.imag
        values = np.stack(
            [self.by_mass + y * second.imag, -y * second.real, -x * second.imag, self.by_mass + x * second.real]
        )
        band = np.bincount(self.place, values[self.keep], self.rows * self.width).reshape(self.rows, self.width).T
        lower, info = lapack.dpbtrf(band, lower=1, overwrite_ab=1)
        if info:
            raise SingularPose
        return lower, arms

    def times_jacobian(self, v: np.ndarray, factor: tuple[np.ndarray, ...]) -> np.ndarray:
        """J v."""
        moved = self.sign * (v[self.turn - 2] + 1j * v[self.turn - 1]) + 1j * factor[1] * v[self.turn]
        return self.per_pin(moved)

    def correction(self, factor: tuple[np.ndarray, ...], right: np.ndarray) -> np.ndarray:
        """M^-1 J^T (J M^-1 J^T)^-1 right: the change, least by mass, of which J makes ``right``."""
        lower, arms = factor
        force = lapack.dpbtrs(lower, right, lower=1)[0].view(complex)[self.pin]
        pushed = self.sign * force
        pulled = np.concatenate([pushed.real, pushed.imag, (arms.conj() * force).imag])
        return self.weight * np.bincount(self.to_coordinates, pulled, self.size)
