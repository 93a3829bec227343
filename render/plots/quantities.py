"""Quantities that pages and spectra show, by name, and the words that ask for them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from render.magnitudes import (
    NOISE,
    couple_floor,
    force_floor,
    force_scale,
    moment_floor,
    shaking,
    speed_scale,
    torque_scale,
    without_noise,
)
from shared.contract import Motion
from shared.stage.errors import UserError, did_you_mean

# Quantities of a motion by the names that SPECTRA gives them: what the machine does to its frame, and parts of it.

SHAKING = ("shaking force", "shaking moment")
COUPLE = "shaking couple"
TURNING, PUSHING = ("torque", "N m"), ("force", "N")
"""Symbol and unit."""


@dataclass(frozen=True)
class Quantity:
    """Series over the times of a motion."""

    name: str
    says: str
    """Description for the page's second line."""
    symbol: str
    unit: str
    components: dict[str, np.ndarray]
    """(T,) each, by the name of its line."""
    floor: float
    """Values below are rounding."""

    @property
    def rows(self) -> np.ndarray:
        """(T, k), rounding taken for zero."""
        return np.stack([without_noise(values, self.floor) for values in self.components.values()], axis=1)


def refuse_unknown(motion: Motion, names: Sequence[str]) -> None:
    """Raise UserError for a name that is no quantity of the motion."""
    known = known_names(motion)
    for name in names:
        if name not in known:
            raise UserError(
                f"{motion.mechanism}: SPECTRA asks for '{name}', which is neither 'shaking force' nor 'shaking moment' "
                f"nor a joint, driver, force, point or body; there is: {', '.join(known)}{did_you_mean(name, known)}"
            )


def refuse_unknown_in_all(motions: Sequence[Motion], names: Sequence[str]) -> None:
    """Raise UserError for a name that is no quantity of any of the motions."""
    known = {name for motion in motions for name in known_names(motion)}
    refuse_unknown(motions[0], [name for name in names if name not in known])


def known_names(motion: Motion) -> list[str]:
    """Return all names of quantities."""
    whole = [*SHAKING, *([COUPLE] if motion.couple else [])]
    own = [motion.joints, motion.drivers, motion.forces, motion.points, motion.bodies]
    return list(dict.fromkeys([*whole, *(name for group in own for name in group)]))


def quantity(motion: Motion, name: str) -> Quantity:
    """Return the quantity with a name of :func:`known_names`."""
    if name in SHAKING or (name == COUPLE and motion.couple):
        return _shaking_quantity(motion, name)
    weak = {"N": NOISE * force_scale(motion), "N m": NOISE * torque_scale(motion)}
    if joint := motion.joints.get(name):
        says = f"reaction of {joint.bodies[0]} on {joint.bodies[1]}, world axes"
        return Quantity(name, says, "force", "N", _xy(joint.fx, joint.fy), weak["N"])
    if driver := motion.drivers.get(name):
        symbol, unit = TURNING if driver.effort_unit == "N m" else PUSHING
        return Quantity(name, "what the driver gives", symbol, unit, {name: np.asarray(driver.effort)}, weak[unit])
    if force := motion.forces.get(name):
        says = force.kind.replace("_", " ")
        if force.effort is None:
            return Quantity(name, says, *PUSHING, _xy(force.actions[0].fx, force.actions[0].fy), weak["N"])
        symbol, unit = TURNING if force.effort_unit == "N m" else PUSHING
        return Quantity(name, says, symbol, unit, {name: np.asarray(force.effort)}, weak[unit])
    return _moving(motion, name)


def _moving(motion: Motion, name: str) -> Quantity:
    """Return the acceleration of a point, or of a body: of its angle where it turns."""
    moving = motion.points.get(name) or motion.bodies[name]
    fastest = speed_scale(motion)
    if name not in motion.points and np.ptp(motion.bodies[name].theta) > NOISE:
        alpha = {name: np.asarray(motion.bodies[name].alpha)}
        says = "angular acceleration of the body"
        return Quantity(name, says, "acceleration", "rad/s²", alpha, NOISE * fastest**2)
    quick = float(np.hypot(moving.vx, moving.vy).max()) * fastest
    says = "acceleration, world axes"
    return Quantity(name, says, "acceleration", "m/s²", _xy(moving.ax, moving.ay), NOISE * quick)


def _shaking_quantity(motion: Motion, name: str) -> Quantity:
    """Return the forces and moments of inertia on the frame."""
    shaken = shaking(motion)
    if name == "shaking force":
        says = "force of inertia on the frame, \N{MINUS SIGN}Σ m a"
        return Quantity(name, says, *PUSHING, _xy(shaken.fx, shaken.fy), force_floor(motion))
    if name == "shaking moment":
        says = f"moment of inertia forces on the frame about {shaken.about}"
        return Quantity(name, says, "moment", "N m", {"moment": shaken.moment}, moment_floor(motion))
    assert motion.couple is not None
    assert shaken.mx is not None
    assert shaken.my is not None
    says = f"couple of inertia forces about axes along x and y, at z = {1000 * motion.couple.about:.4g} mm"
    return Quantity(name, says, "couple", "N m", _xy(shaken.mx, shaken.my), couple_floor(motion))


def _xy(x: Sequence[float] | np.ndarray, y: Sequence[float] | np.ndarray) -> dict[str, np.ndarray]:
    """Return both components; one that is always zero is left out."""
    both = {"x": np.asarray(x), "y": np.asarray(y)}
    largest = max(float(np.abs(values).max()) for values in both.values())
    return {axis: v for axis, v in both.items() if np.abs(v).max() > NOISE * largest} or {"x": both["x"]}
