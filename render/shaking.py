"""What the inertia of all bodies does to the frame: from data.json alone.

    F = -sum m a                                  force (N), a of the centres of mass
    M = -sum [(r - r0) x m a + I alpha]           moment (N m); r0: the axis of the crank, else the origin

Couples about axes in the plane are in data.json, where the model gives bodies places along the normal of the plane.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from render.crank import crank_of
from render.magnitudes import NOISE, centre_of_mass, force_scale, torque_scale, without_noise
from shared.contract import Motion


@dataclass(frozen=True)
class Shaking:
    """(T,) each, rounding as zero: N and N m."""

    fx: np.ndarray
    fy: np.ndarray
    moment: np.ndarray
    about: str
    """What the moment is about, in words."""
    mx: np.ndarray | None = None
    """Couples; None where the model gives no places."""
    my: np.ndarray | None = None


def shaking(motion: Motion) -> Shaking:
    """Force, moment and couples of inertia on the frame."""
    crank = crank_of(motion)
    x0, y0 = crank.at if crank else (0.0, 0.0)
    fx, fy, moment = (np.zeros(len(motion.time)) for _ in range(3))
    for body in motion.bodies.values():
        at = centre_of_mass(body)
        fx, fy = fx - body.mass * at.ax, fy - body.mass * at.ay
        moment -= body.mass * ((at.x - x0) * at.ay - (at.y - y0) * at.ax)
        moment -= body.inertia * np.asarray(body.alpha)
    about = f"the axis of the {crank.body}" if crank else "the origin"
    weak, slack = force_floor(motion), moment_floor(motion)
    couples = [None, None]
    if motion.couple:
        floor = couple_floor(motion)
        couples = [without_noise(np.asarray(values), floor) for values in (motion.couple.mx, motion.couple.my)]
    return Shaking(
        without_noise(fx, weak), without_noise(fy, weak), without_noise(moment, slack), about, couples[0], couples[1]
    )


def force_floor(motion: Motion) -> float:
    """What is rounding in the force (N)."""
    return NOISE * force_scale(motion)


def moment_floor(motion: Motion) -> float:
    """What is rounding in the moment (N m)."""
    return NOISE * torque_scale(motion)


def couple_floor(motion: Motion) -> float:
    """What is rounding in the couples (N m)."""
    return max(moment_floor(motion), NOISE * force_scale(motion) * motion.couple.reach if motion.couple else 0.0)


def floor_of(motion: Motion, name: str, unit: str) -> float:
    """What is rounding in the harmonics of a quantity of data.json's ``vibration``, in its unit."""
    floors = {"shaking force": force_floor, "shaking couple": couple_floor}
    return floors.get(name, moment_floor if unit == "N m" else force_floor)(motion)
