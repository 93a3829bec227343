"""Effects of a counterweight or a balance shaft along a known motion, per unit of its design variable.

A mass m at r (cos a, sin a) about a marker of its body: with u = m (cos a, sin a), R the body's turn and index 0 for
the marker, its force of inertia, its moment about p0 and the power that moves it are linear in u and |u| = m:

    F = -(|u| a0 + r A u)              A = (alpha k x - omega^2) R
    M = -(|u| [(p - p0) x a0 + r^2 alpha] + (p - p0) x r A u + r R u x a0)
    P =  |u| [(a0 - g) . v0 + r^2 alpha omega] + r A u . v0 + (a0 - g) . r omega k x R u

A balance shaft of moment U = (mass times radius) at the angle ratio phi + b: the same about its axis, u = U (cos b,
sin b), without the terms of |u|: the inertia of its own turning belongs to what turns with the crank.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.balancing.means import BalanceShaft, Counterweight

QUANTITIES = ("force", "moment", "couple", "torque")


@dataclass(frozen=True, eq=False)
class Effect:
    """(T, k, 3) per unit of (u_x, u_y, |u|); k is 2 of a vector, 1 of a scalar."""

    force: np.ndarray
    moment: np.ndarray
    couple: np.ndarray
    power: np.ndarray

    def on(self, quantity: str, rate: np.ndarray) -> np.ndarray:
        """Return the effect on a quantity; a driver's torque is power divided by its ``rate`` (T,)."""
        return self.power / rate[:, None, None] if quantity == "torque" else getattr(self, quantity)


@dataclass(frozen=True, eq=False)
class _Turning:
    """A mass at one end of an arm that turns about a place: (T,) and (T, 2) series."""

    place: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    angle: np.ndarray
    omega: np.ndarray
    alpha: np.ndarray
    radius: float
    has_mass: bool


def effect_of_weight(sol: Any, weight: Counterweight, about: tuple[float, float], z0: float) -> Effect:
    """Effect of a counterweight along the motion of a Solution."""
    at, body = sol.place(weight.about), sol.body(weight.body)
    turning = _Turning(
        np.stack([at.x, at.y], axis=-1), np.stack([at.vx, at.vy], axis=-1), np.stack([at.ax, at.ay], axis=-1),
        body.theta, body.omega, body.alpha, weight.radius, has_mass=True,
    )  # fmt: skip
    return _effect(turning, about, weight.plane - z0, np.array(sol.mechanism.gravity))


def effect_of_shaft(sol: Any, shaft: BalanceShaft, crank: str, about: tuple[float, float], z0: float) -> Effect:
    """Effect of a balance shaft that the body ``crank`` turns."""
    body, still = sol.body(crank), np.zeros((len(sol.t), 2))
    turning = _Turning(
        still + np.asarray(shaft.at), still, still,
        shaft.ratio * body.theta, shaft.ratio * body.omega, shaft.ratio * body.alpha, 1.0, has_mass=False,
    )  # fmt: skip
    return _effect(turning, about, shaft.z - z0, np.array(sol.mechanism.gravity))


def _effect(of: _Turning, about: tuple[float, float], z: float, gravity: np.ndarray) -> Effect:
    arm = of.place - np.asarray(about)
    felt = of.acceleration - gravity
    turned = [_turned(of.angle, unit) for unit in (0.0, 0.5 * np.pi)]
    pushed = [of.alpha[:, None] * _quarter(e) - (of.omega**2)[:, None] * e for e in turned]
    r, mass = of.radius, float(of.has_mass)
    force = -np.stack([r * pushed[0], r * pushed[1], mass * of.acceleration], axis=-1)
    moment = -np.stack(
        [
            *(r * (_cross(arm, p) + _cross(e, of.acceleration)) for e, p in zip(turned, pushed, strict=True)),
            mass * (_cross(arm, of.acceleration) + r**2 * of.alpha),
        ],
        axis=-1,
    )
    power = np.stack(
        [
            *(
                r * ((p * of.velocity).sum(axis=1) + of.omega * (felt * _quarter(e)).sum(axis=1))
                for e, p in zip(turned, pushed, strict=True)
            ),
            mass * ((felt * of.velocity).sum(axis=1) + r**2 * of.alpha * of.omega),
        ],
        axis=-1,
    )
    couple = z * np.stack([-force[:, 1], force[:, 0]], axis=1)
    return Effect(force, moment[:, None], couple, power[:, None])


def _turned(angle: np.ndarray, by: float) -> np.ndarray:
    return np.stack([np.cos(angle + by), np.sin(angle + by)], axis=-1)


def _quarter(vector: np.ndarray) -> np.ndarray:
    """k x vector."""
    return np.stack([-vector[:, 1], vector[:, 0]], axis=-1)


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
