"""Rods that carry pins of other rods in their own plane, as the master rod of a radial engine does (mm).

The big end of such a carrier is a fork: two flanges with the knuckle pins from one to the other, and between them the
eyes of the carried rods, as thick as the carrier's shank. All in all it is

    height = 2 flange + 2 gap + middle,    middle = MIDDLE (height - 2 gap)

high. Radii are parts of the bore.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.shafts.bodies.planes import SAME
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from mechanisms.stages.automatic.shafts.bodies.kinds import Link, LinkEye, Machine, Shaft, Throw

KNUCKLE_PIN, KNUCKLE_EYE = 0.1, 0.17
HUB = 0.34
"""Radius of the carrier's big end between its flanges."""
BESIDE = 0.02
"""Between that and the eye of a carried rod."""
MIDDLE = 0.62


def carrier(machine: Machine, link: Link) -> Link | None:
    """The rod on a crank pin from which a rod of a piston hangs in the same plane; None of other links."""
    if _crank_eye(machine, link) is not None or not _drives(machine, link):
        return None
    for eye in link.eyes:
        other = machine.links.get(eye.on)
        if other is not None and abs(other.z - link.z) < SAME and _crank_eye(machine, other) is not None:
            return other if _drives(machine, other) else None
    return None


def knuckle_eyes(machine: Machine, link: Link) -> list[LinkEye]:
    """Those of a carrier that carry rods, and of a carried rod the one on its carrier."""
    above = carrier(machine, link)
    if above is not None:
        return [eye for eye in link.eyes if eye.on == above.body]
    others = [(eye, machine.links[eye.on]) for eye in link.eyes if eye.on in machine.links]
    return [eye for eye, other in others if carrier(machine, other) is link]


def is_carrier(machine: Machine, link: Link) -> bool:
    """Whether rods hang from it in its plane."""
    return carrier(machine, link) is None and bool(knuckle_eyes(machine, link))


def carries(machine: Machine, a: Link, b: Link) -> bool:
    """Whether one of two links hangs from the other in its plane."""
    return carrier(machine, a) is b or carrier(machine, b) is a


def throw_of(machine: Machine, link: Link) -> tuple[Shaft, Throw] | None:
    """The crank pin that a link turns on, or its carrier."""
    body = (carrier(machine, link) or link).body
    every = [(shaft, throw) for shaft in machine.shafts.values() for throw in shaft.throws]
    return next((pair for pair in every if pair[1].link == body), None)


def rod_foot(machine: Machine, link: Link) -> LinkEye | None:
    """The eye of a rod that is away from its piston: on the crank pin, or on its carrier."""
    return _crank_eye(machine, link) or next(iter(knuckle_eyes(machine, link)), None)


def ring_reach(machine: Machine, link: Link, bore: float) -> float:
    """How far the flanges of a rod's carrier, or its own, reach from the crank pin; 0 without flanges."""
    own = carrier(machine, link) or link
    main = _crank_eye(machine, own)
    if main is None:
        return 0.0
    away = [math.hypot(eye.x - main.x, eye.y - main.y) for eye in knuckle_eyes(machine, own)]
    return max(away) + KNUCKLE_EYE * bore if away else 0.0


def refuse_near(machine: Machine, link: Link, bore: float) -> None:
    """Raise UserError for knuckle pins of a carrier that leave the eyes on them no room."""
    main = _crank_eye(machine, link)
    if main is None:
        return
    least = (HUB + BESIDE + KNUCKLE_EYE) * bore
    places = [(eye.on, eye.x, eye.y) for eye in knuckle_eyes(machine, link)]
    for k, (body, x, y) in enumerate(places):
        away = math.hypot(x - main.x, y - main.y)
        if away < least:
            raise UserError(
                f"{machine.m.name}: '{body}' turns on '{link.body}' {away:.4g} mm from the crank pin, and with a bore "
                f"of {bore:.4g} mm its eye beside the big end needs {least:.4g} mm; move the knuckle pin out, or make "
                "the bore smaller"
            )
        for other, u, v in places[:k]:
            if math.hypot(x - u, y - v) < (2 * KNUCKLE_EYE + BESIDE) * bore:
                raise UserError(
                    f"{machine.m.name}: '{other}' and '{body}' turn on '{link.body}' {math.hypot(x - u, y - v):.4g} mm "
                    f"from each other, and their eyes need {(2 * KNUCKLE_EYE + BESIDE) * bore:.4g} mm; move the "
                    "knuckle pins out, or make the bore smaller"
                )


def middle(height: float, gap: float) -> float:
    """Thickness between the flanges of a carrier of that height."""
    return MIDDLE * (height - 2 * gap)


def flange(height: float, gap: float) -> float:
    """Thickness of each flange."""
    return (height - 2 * gap - middle(height, gap)) / 2


def height_for(thickness: float, gap: float) -> float:
    """Height of a carrier, for rods of that thickness."""
    return thickness / MIDDLE + 2 * gap


def _crank_eye(machine: Machine, link: Link) -> LinkEye | None:
    return next((eye for eye in link.eyes if eye.on in machine.shafts), None)


def _drives(machine: Machine, link: Link) -> bool:
    """Whether a link moves a piston; pistons are those of the model, as theirs follow links."""
    slides = {body for joint in machine.m.joints.values() if joint.kind.name == "prismatic" for body in joint.bodies}
    return any(eye.on in slides and eye.on != "ground" for eye in link.eyes)
