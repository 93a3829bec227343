"""Cylinder of a model: the motion of its piston, from given numbers or from the joints.

    V = A (x - x_t + c)             x: of the piston's marker along the cylinder's, x_t at the top dead centre
    c = stroke / (compression - 1)
    phi = sense (theta_crank - theta_cylinder - fires_at)

The joints tell the motion by a rod, by a rod on another's master rod, or by a slot. The crank turns on a pin of the
cylinder's body and the piston slides on it; x counts from the head towards the crank.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from mbsd.base.errors import ModelError
from mbsd.model.body import Marker
from mbsd.model.cylinders.cycle import TURN, Bore, GasCycle
from mbsd.model.cylinders.piston_motion import ArticulatedMotion, PistonMotion, lowest

if TYPE_CHECKING:
    from mbsd.model.force import Force
    from mbsd.model.joint import Joint


SQUARE = 1e-6
"""rad: how far a slot may be from square to its cylinder, or a rail from parallel to it."""
HERE = 1e-9
"""m: a rail's marker so near to the crank's axis is on neither side of it."""
Found = tuple[PistonMotion | ArticulatedMotion, float, float]
"""Motion, place of the piston's marker (m) and angle of the crank against the cylinder's body at the top (rad)."""


def motion_of_joints(force: Force, joints: Sequence[Joint], sense: float) -> Found:
    """Motion of the piston of a gas_cycle. Raises ModelError where it does not follow from the joints."""
    frame, piston, crank = *force.bodies, force.params["crank"]
    bearing = next(_between(joints, "revolute", frame, crank), None)
    guide = next(_between(joints, "prismatic", frame, piston), None)
    if bearing is None or guide is None:
        raise _unknown(force, "a revolute joint of the crank or a prismatic joint of the piston on that body")
    if abs(math.sin(guide[0].angle - force.i.angle)) > SQUARE:
        raise _unknown(force, "a prismatic joint along the x axis of that marker")
    own = _Line(force.i.angle, bearing[0], *guide)
    start = -own.from_axis(force.i)[0]
    if start <= 0.0:
        raise ModelError(
            f"force '{force.name}': its first marker, the cylinder's, must have its x axis from the head towards "
            f"'{crank}', whose axis lies {start:.6g} m along it. Turn the marker, or give stroke= and rod="
        )
    others = dict.fromkeys(name for joint in joints for name in joint.bodies if name not in (frame, piston, crank))
    for rod in others:
        for wrist in _between(joints, "revolute", rod, piston):
            reach = own.of_piston(force.j)[0] - own.of_piston(wrist[1])[0]
            for pin in _between(joints, "revolute", rod, crank):
                throw, ahead = _polar(pin[1], bearing[1])
                motion = PistonMotion(throw, _distance(wrist[0], pin[0]), own.of_piston(wrist[1])[1], sense)
                if not motion.turns:
                    raise ModelError(
                        f"force '{force.name}': the rod '{rod}' is {motion.rod:g} m long, the throw of '{crank}' "
                        f"{throw:g} m and the offset of the cylinder {motion.offset:g} m. For a crank that turns, "
                        "make the rod longer than both together"
                    )
                return motion, start - motion.reach + reach, _wrapped(motion.top - ahead + own.angle)
            for master in others:
                for knuckle in _between(joints, "revolute", rod, master):
                    hung = _hung(force, joints, (rod, master), (wrist, knuckle), own, bearing, sense)
                    if hung is not None:
                        motion, turned = hung
                        return motion, start - motion.reach + reach, turned
    for slot, pin in _between(joints, "pin_in_slot", piston, crank):
        if abs(math.cos(slot.angle + own.turned)) <= SQUARE:
            throw, ahead = _polar(pin, bearing[1])
            reach = own.of_piston(force.j)[0] - own.of_piston(slot)[0]
            return (
                PistonMotion(throw, math.inf, 0.0, sense),
                start - throw + reach,
                _wrapped(TURN / 2 - ahead + own.angle),
            )
    raise _unknown(force, f"a rod with revolute joints on '{piston}' and '{crank}', or on the rod of another piston")


class _Line:
    """Axes of a cylinder on its body, x towards the crank, and its piston, which does not turn on it."""

    def __init__(self, angle: float, bearing: Marker, on_frame: Marker, on_piston: Marker) -> None:
        self.angle, self.bearing, self.rail = angle, bearing, on_piston
        self.turned = on_frame.angle - on_piston.angle - angle
        """Angle of the piston's frame (rad)."""
        self.across = self.from_axis(on_frame)[1]

    def from_axis(self, place: Marker) -> tuple[float, float]:
        """A place of the cylinder's body from the crank's axis: along and to the left (m)."""
        return _rotated(place.x - self.bearing.x, place.y - self.bearing.y, -self.angle)

    def of_piston(self, place: Marker) -> tuple[float, float]:
        """A place of the piston: along, from its rail, and to the left of the crank's axis (m)."""
        along, left = _rotated(place.x - self.rail.x, place.y - self.rail.y, self.turned)
        return along, self.across + left


def _hung(
    force: Force,
    joints: Sequence[Joint],
    rods: tuple[str, str],
    pins: tuple[tuple[Marker, Marker], tuple[Marker, Marker]],
    own: _Line,
    bearing: tuple[Marker, Marker],
    sense: float,
) -> tuple[ArticulatedMotion, float] | None:
    """Return the motion by a rod on a master rod, and the crank's angle.

    ``rods`` have their markers at wrist and knuckle.

    None where the other is no master rod. The master's head is on the side of the crank on which its rail's marker on
    the cylinder's body lies; of one on the axis, where its x axis points.
    """
    frame, crank, (rod, master), (wrist, knuckle) = force.bodies[0], force.params["crank"], rods, pins
    big = next(_between(joints, "revolute", master, crank), None)
    if big is None:
        return None
    for name in dict.fromkeys(name for joint in joints for name in joint.bodies if name not in (rod, crank, frame)):
        small = next(_between(joints, "revolute", master, name), None)
        guide = next(_between(joints, "prismatic", frame, name), None)
        if small is None or guide is None:
            continue
        away = _rotated(guide[0].x - bearing[0].x, guide[0].y - bearing[0].y, -guide[0].angle)[0]
        leader = _Line(guide[0].angle + (0.0 if away < -HERE else TURN / 2), bearing[0], *guide)
        throw, ahead = _polar(big[1], bearing[1])
        length, lies = _polar(small[0], big[0])
        motion = ArticulatedMotion(
            throw,
            length,
            leader.of_piston(small[1])[1],
            _rotated(knuckle[1].x - big[0].x, knuckle[1].y - big[0].y, -lies),
            own.angle - leader.angle,
            _distance(wrist[0], knuckle[0]),
            own.of_piston(wrist[1])[1],
            sense,
        )
        if not motion.turns:
            raise ModelError(
                f"force '{force.name}': the rods '{master}' ({length:g} m) and '{rod}' ({motion.rod:g} m) do not let "
                f"'{crank}' go round, whose throw is {throw:g} m; make them longer"
            )
        return motion, _wrapped(motion.top - ahead + leader.angle)
    return None


def _between(joints: Sequence[Joint], kind: str, first: str, second: str) -> Iterator[tuple[Marker, Marker]]:
    """Yield markers on both bodies of all joints of a kind between them; slots are on the first."""
    for joint in joints:
        if joint.kind.name == kind:
            if joint.bodies == (first, second):
                yield joint.i, joint.j
            elif joint.bodies == (second, first) and kind != "pin_in_slot":
                yield joint.j, joint.i


def _rotated(x: float, y: float, angle: float) -> tuple[float, float]:
    c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y


def _wrapped(angle: float) -> float:
    return math.remainder(angle, TURN)


def _distance(first: Marker, second: Marker) -> float:
    return math.hypot(first.x - second.x, first.y - second.y)


def _polar(pin: Marker, axis: Marker) -> tuple[float, float]:
    """Distance (m) of a pin from another place of its body, and its direction in the body's frame (rad)."""
    x, y = pin.x - axis.x, pin.y - axis.y
    return math.hypot(x, y), math.atan2(y, x)


def _unknown(force: Force, missing: str) -> ModelError:
    return ModelError(
        f"force '{force.name}': the joints do not tell how '{force.params['crank']}' moves "
        f"'{force.bodies[1]}' against '{force.bodies[0]}': there is not {missing}; give stroke=, rod=, top= and "
        "fires_at="
    )


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
                "the model). Correct it, or leave it out"
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
