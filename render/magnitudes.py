"""Magnitudes of a motion: of the crank, of vectors, of the shaking force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shared.contract import BodyMotion, Motion

# The crank of a motion: what turns round and round on ground, by whose angle engineers draw everything else.

WHOLE = 1e-6
"""Turns: what misses a whole number by less is one."""


@dataclass(frozen=True)
class Crank:
    """A body that a revolute joint holds on ground and that turns one way from row ``first`` on."""

    body: str
    angle: np.ndarray
    """(T,) turned since the start, counted positive in the direction of the last turn (rad)."""
    first: int
    at: tuple[float, float]
    """Its axis (m)."""

    @property
    def turns(self) -> int:
        """Whole turns from ``first`` on."""
        return int((self.angle[-1] - self.angle[self.first]) / (2 * np.pi) + WHOLE)


def crank_of(motion: Motion) -> Crank | None:
    """Return the crank: the one that a driver turns, else the first in the file; None without any."""
    cranks = [crank for body, at in _on_ground(motion).items() if (crank := _crank(motion, body, at)) is not None]
    driven = driven_bodies(motion)
    return min(cranks, key=lambda crank: crank.body not in driven, default=None)


def travels(motion: Motion, name: str) -> bool:
    """Return True if no pins, guides and slots hold a body, or the body of a point or joint, on ground."""
    held, pairs = {"ground"}, [set(joint.bodies) for joint in motion.joints.values() if joint.pair is not None]
    while more := {body for pair in pairs if pair & held for body in pair} - held:
        held |= more
    if name in motion.joints:
        return not held & set(motion.joints[name].bodies)
    return (motion.points[name].body if name in motion.points else name) not in held


def driven_bodies(motion: Motion) -> set[str]:
    """Return bodies that drivers act between, without ground."""
    return {body for driver in motion.drivers.values() for body in driver.bodies or () if body != "ground"}


def _on_ground(motion: Motion) -> dict[str, tuple[float, float]]:
    """Return bodies that revolute joints hold on ground, with the axis."""
    pins: dict[str, tuple[float, float]] = {}
    for joint in motion.joints.values():
        if joint.pair == "pin" and "ground" in joint.bodies:
            for body in joint.bodies:
                if body != "ground":
                    pins.setdefault(body, (joint.x[0], joint.y[0]))
    return pins


def _crank(motion: Motion, body: str, at: tuple[float, float]) -> Crank | None:
    angle = np.asarray(motion.bodies[body].theta)
    steps = np.diff(angle) * (1.0 if angle[-1] >= angle[len(angle) // 2] else -1.0)
    back = np.flatnonzero((steps <= 0) & (np.diff(motion.time) > 0))
    crank = Crank(
        body,
        np.abs(angle - angle[0]) if not len(back) else np.concatenate([[0.0], np.cumsum(steps)]),
        int(back[-1]) + 1 if len(back) else 0,
        at,
    )
    return crank if crank.turns else None


# Computes how large the quantities of a motion are, so that rounding errors are drawn as zero and not as a curve.
#
# A number is noise where it is below :data:`NOISE` of what it is the difference of: a reaction beside the weights and
# inertia forces, a power beside the powers that cancel in it.

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
    """Return the motion of the centre of mass, from that of the body's frame."""
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
    """Return the largest angular velocity (rad/s)."""
    return max((float(np.abs(body.omega).max()) for body in motion.bodies.values()), default=0.0)


def force_scale(motion: Motion) -> float:
    """Return the largest of reactions, weights and inertia forces (N)."""
    gravity = float(np.hypot(*motion.gravity))
    sizes = [float(np.hypot(joint.fx, joint.fy).max()) for joint in motion.joints.values()]
    for body in motion.bodies.values():
        centre = centre_of_mass(body)
        sizes.append(body.mass * max(gravity, float(np.hypot(centre.ax, centre.ay).max())))
    return max(sizes, default=0.0)


def length_scale(motion: Motion) -> float:
    """Return the diagonal of all that joints sweep (m)."""
    x = [value for joint in motion.joints.values() for value in (min(joint.x), max(joint.x))]
    y = [value for joint in motion.joints.values() for value in (min(joint.y), max(joint.y))]
    return float(np.hypot(max(x) - min(x), max(y) - min(y))) if x else 0.0


def torque_scale(motion: Motion) -> float:
    """Return the largest force on an arm as long as the mechanism, and what turning parts need (N m)."""
    size = length_scale(motion)
    turning = [
        body.inertia * max(float(np.abs(body.alpha).max()), float(np.abs(body.omega).max()) ** 2)
        for body in motion.bodies.values()
    ]
    return max([force_scale(motion) * size, *turning])


def effort_floor(motion: Motion, pushes: bool) -> float:
    """Return the rounding in the effort of a driver or force: N if it ``pushes``, else N m."""
    return NOISE * (force_scale(motion) if pushes else torque_scale(motion))


def energy_floor(motion: Motion) -> float:
    """Return the rounding in an energy (J)."""
    kinetic, potential = np.asarray(motion.energy.kinetic), np.asarray(motion.energy.potential)
    moved = max(float(kinetic.max()), float(np.ptp(potential)))
    return max(NOISE * moved, ROUNDING * float(np.abs(potential).max()))


def power_floor(motion: Motion) -> float:
    """Return the rounding in a power (W), beside those of drivers, weights, inertia forces and turning."""
    gravity = float(np.hypot(*motion.gravity))
    largest = [max(motion.energy.kinetic) * speed_scale(motion)]
    largest += [float(np.abs(driver.power).max()) for driver in motion.drivers.values()]
    for body in motion.bodies.values():
        centre = centre_of_mass(body)
        pull = body.mass * (np.hypot(centre.ax, centre.ay) + gravity) * np.hypot(centre.vx, centre.vy)
        largest.append(float((pull + body.inertia * np.abs(np.multiply(body.alpha, body.omega))).max()))
    return NOISE * max(largest)


def floors(motion: Motion) -> dict[str, float]:
    """Return the rounding in a motion's numbers, by SI unit; units without a scale are left out."""
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
    """Return the values, those below ``floor`` as zero; a constant but for ``floor`` as a constant."""
    if len(values) and np.ptp(values) <= floor:
        middle = float(np.median(values))
        return np.full(len(values), middle if abs(middle) > floor else 0.0)
    return np.where(np.abs(values) <= floor, 0.0, values)


# Inertia forces of all bodies on the frame, from data.json alone.
#
#     F = -sum m a                                  force (N), a of the centres of mass
#     M = -sum [(r - r0) x m a + I alpha]           moment (N m); r0: the axis of the crank, else the origin
#
# Couples about axes in the plane are in data.json, where the model gives bodies places along the normal of the plane.


@dataclass(frozen=True)
class Shaking:
    """(T,) each, rounding as zero: N and N m."""

    fx: np.ndarray
    fy: np.ndarray
    moment: np.ndarray
    about: str
    """Point or axis of the moment, in words."""
    mx: np.ndarray | None = None
    """Couples; None where the model gives no places."""
    my: np.ndarray | None = None


def shaking(motion: Motion) -> Shaking:
    """Return the force, moment and couples of inertia on the frame."""
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
    """Return the rounding in the force (N)."""
    return NOISE * force_scale(motion)


def moment_floor(motion: Motion) -> float:
    """Return the rounding in the moment (N m)."""
    return NOISE * torque_scale(motion)


def couple_floor(motion: Motion) -> float:
    """Return the rounding in the couples (N m)."""
    return max(moment_floor(motion), NOISE * force_scale(motion) * motion.couple.reach if motion.couple else 0.0)


def floor_of(motion: Motion, name: str, unit: str) -> float:
    """Return the rounding in the harmonics of a quantity of data.json's ``vibration``, in its unit."""
    floors = {"shaking force": force_floor, "shaking couple": couple_floor}
    return floors.get(name, moment_floor if unit == "N m" else force_floor)(motion)
