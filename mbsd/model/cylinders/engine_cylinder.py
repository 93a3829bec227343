"""Cylinder of a model: the motion of its piston, from given numbers or from the joints.

V = A (x - x_t + c)             x: of the piston's marker along the cylinder's, x_t at the top dead centre
c = stroke / (compression - 1)
phi = sense (theta_crank - theta_cylinder - fires_at)
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from mbsd.base.errors import ModelError
from mbsd.model.cylinders.cycle import TURN, Bore, GasCycle
from mbsd.model.cylinders.from_joints import motion_of_joints
from mbsd.model.cylinders.piston_motion import PistonMotion, lowest

if TYPE_CHECKING:
    from mbsd.model.force import Force
    from mbsd.model.joint import Joint

CLOSE = 1e-3
"""rad: how far ``fires_at`` may be from a top dead centre that the joints give."""


@dataclass(frozen=True)
class EngineCylinder:
    """The cylinder of an engine: all that its pressure follows from, beside its cycle."""

    bore: Bore
    top: float
    """x_t (m)"""
    fires_at: float
    """Angle of the crank against the cylinder's body (rad)."""
    sense: float
    """-1: the crank turns clockwise."""

    @property
    def shift(self) -> float:
        """The length (m) that makes the height of the gas of x."""
        return self.bore.clearance - self.top


def cylinder_of(force: Force, joints: Sequence[Joint]) -> EngineCylinder:
    """Return the cylinder of a force of kind gas_cycle.

    Raises ModelError if neither numbers nor joints decide it.
    """
    p, what = force.params, f"force '{force.name}'"
    cycle: GasCycle = p["cycle"]
    sense = -1.0 if p["clockwise"] else 1.0
    if p["stroke"] is None:
        motion, top, dead = motion_of_joints(force, joints, sense)
        fires_at = dead if p["fires_at"] is None else p["fires_at"]
        if abs(math.remainder(fires_at - dead, TURN)) > CLOSE:
            raise ModelError(
                f"{what}: fires_at is {math.degrees(fires_at):.6g} degrees, but its piston is at the top dead centre "
                f"with the crank at {math.degrees(dead):.6g} or {math.degrees(dead + TURN):.6g} degrees (radians in "
                "the model); correct it, or leave it out"
            )
    else:
        motion = given_motion(what, p["stroke"], p["rod"], p["offset"], sense)
        top, fires_at = 0.0, _top_by_joints(force, joints, sense) if p["fires_at"] is None else p["fires_at"]
    ratio = cycle.compression
    clearance = 0.0 if ratio is None else motion.stroke / (ratio - 1.0)
    bore = Bore(math.pi / 4.0 * p["bore"] ** 2, clearance, motion)
    return EngineCylinder(bore, top if p["top"] is None else p["top"], fires_at, sense)


def _top_by_joints(force: Force, joints: Sequence[Joint], sense: float) -> float:
    """Return the crank angle (rad) at which the piston is nearest to its head.

    Raises ModelError if joints do not decide it.

    The head may lie between the piston and the crank, as that of the second chamber of a steam engine does.
    """
    turned = replace(force, i=replace(force.i, angle=force.i.angle + math.pi))
    for own, beyond in ((force, False), (turned, True)):
        try:
            motion, _, dead = motion_of_joints(own, joints, sense)
        except ModelError:
            continue
        return dead + sense * lowest(motion) if beyond else dead
    raise ModelError(
        f"force '{force.name}': fires_at is missing. stroke= does not tell at which angle of '{force.params['crank']}' "
        f"'{force.bodies[1]}' is at its top dead centre, and the joints do not either; give fires_at= (rad)"
    )


def given_motion(what: str, stroke: float, rod: float | None, offset: float, sense: float) -> PistonMotion:
    """Motion by the numbers of a slider-crank, or without a rod of a Scotch yoke.

    r = S sqrt((l^2 - e^2 - S^2 / 4) / (4 l^2 - S^2)). Raises ModelError for a rod with which the crank does not turn.
    """
    if rod is None:
        return PistonMotion(0.5 * stroke, math.inf, 0.0, sense)
    inside = rod**2 - offset**2 - 0.25 * stroke**2
    throw = stroke * math.sqrt(inside / (4.0 * rod**2 - stroke**2)) if inside > 0.0 and 2.0 * rod > stroke else rod
    motion = PistonMotion(throw, rod, offset, sense)
    if not motion.turns:
        raise ModelError(
            f"{what}: rod is {rod:g} m; for a stroke of {stroke:g} m and an offset of {offset:g} m it must be longer "
            "than throw and offset together"
        )
    return motion
