"""Computes how large the quantities of a motion are, so that rounding errors are drawn as zero and not as a curve.

A number is noise where it is below :data:`NOISE` of what it is the difference of: a reaction beside the weights and
inertia forces, a power beside the powers that cancel in it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shared.contract import BodyMotion, Motion

NOISE = 1e-9
"""Relative to the scale of a quantity."""
ROUNDING = 1e-13
"""Relative to a number that was subtracted from another."""


@dataclass(frozen=True)
class Centre:
    """Motion of a body's centre of mass, (T,) arrays: place (m), velocity, acceleration."""

    x: np.ndarray
    y: np.ndarray
    vx: np.ndarray
    vy: np.ndarray
    ax: np.ndarray
    ay: np.ndarray


def centre_of_mass(body: BodyMotion) -> Centre:
    """From the motion of the body's frame."""
    c, s = np.cos(body.theta), np.sin(body.theta)
    rx, ry = c * body.com[0] - s * body.com[1], s * body.com[0] + c * body.com[1]
    omega, alpha = np.asarray(body.omega), np.asarray(body.alpha)
    return Centre(
        body.x + rx,
        body.y + ry,
        body.vx - omega * ry,
        body.vy + omega * rx,
        body.ax - alpha * ry - omega**2 * rx,
        body.ay + alpha * rx - omega**2 * ry,
    )


def speed_scale(motion: Motion) -> float:
    """The largest angular velocity (rad/s)."""
    return max((float(np.abs(body.omega).max()) for body in motion.bodies.values()), default=0.0)


def force_scale(motion: Motion) -> float:
    """The largest of reactions, weights and inertia forces (N)."""
    gravity = float(np.hypot(*motion.gravity))
    sizes = [float(np.hypot(joint.fx, joint.fy).max()) for joint in motion.joints.values()]
    for body in motion.bodies.values():
        centre = centre_of_mass(body)
        sizes.append(body.mass * max(gravity, float(np.hypot(centre.ax, centre.ay).max())))
    return max(sizes, default=0.0)


def length_scale(motion: Motion) -> float:
    """The diagonal of all that joints sweep (m)."""
    x = [value for joint in motion.joints.values() for value in (min(joint.x), max(joint.x))]
    y = [value for joint in motion.joints.values() for value in (min(joint.y), max(joint.y))]
    return float(np.hypot(max(x) - min(x), max(y) - min(y))) if x else 0.0


def torque_scale(motion: Motion) -> float:
    """The largest force on an arm as long as the mechanism, and what turning parts need (N m)."""
    size = length_scale(motion)
    turning = [
        body.inertia * max(float(np.abs(body.alpha).max()), float(np.abs(body.omega).max()) ** 2)
        for body in motion.bodies.values()
    ]
    return max([force_scale(motion) * size, *turning])


def effort_floor(motion: Motion, pushes: bool) -> float:
    """What is rounding in the effort of a driver or force: N where it ``pushes``, else N m."""
    return NOISE * (force_scale(motion) if pushes else torque_scale(motion))


def energy_floor(motion: Motion) -> float:
    """What is rounding in an energy (J)."""
    kinetic, potential = np.asarray(motion.energy.kinetic), np.asarray(motion.energy.potential)
    moved = max(float(kinetic.max()), float(np.ptp(potential)))
    return max(NOISE * moved, ROUNDING * float(np.abs(potential).max()))


def power_floor(motion: Motion) -> float:
    """What is rounding in a power (W), beside those of drivers, weights, inertia forces and turning itself."""
    gravity = float(np.hypot(*motion.gravity))
    largest = [max(motion.energy.kinetic) * speed_scale(motion)]
    largest += [float(np.abs(driver.power).max()) for driver in motion.drivers.values()]
    for body in motion.bodies.values():
        centre = centre_of_mass(body)
        pull = body.mass * (np.hypot(centre.ax, centre.ay) + gravity) * np.hypot(centre.vx, centre.vy)
        largest.append(float((pull + body.inertia * np.abs(np.multiply(body.alpha, body.omega))).max()))
    return NOISE * max(largest)


def floors(motion: Motion) -> dict[str, float]:
    """Return what is rounding in the numbers of a motion, by their SI unit; units without a scale are left out."""
    centres = [centre_of_mass(body) for body in motion.bodies.values()]
    ends = [float(np.hypot(np.ptp(at.x), np.ptp(at.y))) for at in centres]
    fastest = max((float(np.hypot(at.vx, at.vy).max()) for at in centres), default=0.0)
    hardest = max((float(np.hypot(at.ax, at.ay).max()) for at in centres), default=0.0)
    span, power = float(motion.time[-1] - motion.time[0]), power_floor(motion)
    return {
        "m": NOISE * max([length_scale(motion), *ends]),
        "rad": NOISE,
        "m/s": NOISE * fastest,
        "m/s²": NOISE * hardest,
        "rad/s": NOISE * speed_scale(motion),
        "N": effort_floor(motion, True),
        "N m": effort_floor(motion, False),
        "W": power,
        "J": max(energy_floor(motion), power * span),
    }


def without_noise(values: np.ndarray, floor: float) -> np.ndarray:
    """The values, those below ``floor`` as zero; a constant but for ``floor`` as a constant."""
    if len(values) and np.ptp(values) <= floor:
        middle = float(np.median(values))
        return np.full(len(values), middle if abs(middle) > floor else 0.0)
    return np.where(np.abs(values) <= floor, 0.0, values)
