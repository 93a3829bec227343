"""What each body of a machine with places along the normal becomes: a shaft, a link in one plane, or a piston (mm)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.shafts.planes import SAME, marker_on, other_on, place, plane, planes
from shared.shapes.units import mm
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from mbsd import Mechanism
    from mbsd.model.joint import Joint

type Point = tuple[float, float]
JOINTS = ("revolute", "prismatic")
"""Kinds of joints that have parts where bodies have places along the normal."""
SHAPELESS = ("angle_lock", "constraint")
NEAR = 0.01
"""Places on a body that are nearer than this are one (mm)."""


@dataclass(frozen=True)
class Throw:
    """A crank pin's part that carries one link, in the shaft's frame."""

    joint: str
    link: str
    x: float
    y: float
    z: float


@dataclass(frozen=True, eq=False)
class Shaft:
    """A body that turns on ground and carries links in several planes."""

    body: str
    joint: str
    axis: Point
    """Its axis in its own frame."""
    at: Point
    """Its axis on ground."""
    throws: tuple[Throw, ...]
    """In the order of their planes."""

    def radius(self, throw: Throw) -> float:
        """How far a throw is from the axis."""
        return math.hypot(throw.x - self.axis[0], throw.y - self.axis[1])


@dataclass(frozen=True)
class LinkEye:
    """A joint of a link: ``on`` is a shaft, a piston, ground, or another link; a free end has neither."""

    joint: str
    on: str
    x: float
    y: float


@dataclass(frozen=True, eq=False)
class Link:
    """A body whose joints all lie in one plane."""

    body: str
    z: float
    eyes: tuple[LinkEye, ...]


@dataclass(frozen=True, eq=False)
class Piston:
    """A body that slides along a line of ground."""

    body: str
    joint: str
    z: float
    along: Point
    """Unit vector on ground, away from what drives it."""
    line: Point
    """A place of ground on the line of its middle."""
    turn: float
    """Direction of ``along`` in its own frame (rad)."""
    wrist: Point
    """The place of its wrist pin in its own frame."""
    aside: float
    """From the line of its middle to the wrist pin, to the left of ``along``."""
    link: str | None
    """What drives it."""
    wrist_joint: str
    area: float | None
    """Of the bore (mm^2), where gas acts on it."""


@dataclass(frozen=True, eq=False)
class Machine:
    """All bodies that get parts, by what they become."""

    m: Mechanism
    poses: Mapping[str, np.ndarray]
    """By body, (T, 3): x, y (mm) and theta (rad) over the motion."""
    times: np.ndarray
    shafts: dict[str, Shaft] = field(default_factory=dict)
    links: dict[str, Link] = field(default_factory=dict)
    pistons: dict[str, Piston] = field(default_factory=dict)
    left_out: frozenset[str] = frozenset()

    def path(self, body: str, x: float, y: float) -> np.ndarray:
        """(T, 2): a place of a body on ground over the motion."""
        pose = self.poses[body]
        c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
        return np.stack([pose[:, 0] + c * x - s * y, pose[:, 1] + s * x + c * y], axis=1)


def machine(
    m: Mechanism,
    poses: Mapping[str, np.ndarray],
    times: np.ndarray,
    left_out: Collection[str],
    chosen: Mapping[str, float] | None = None,
) -> Machine:
    """Tell bodies apart; ``chosen`` are places (mm) of links that the model gives none.

    Raises UserError, with the body and the remedy, for what has no parts here.
    """
    found = Machine(m, poses, times, left_out=frozenset(left_out))
    bodies = [name for name in m.bodies if name != "ground" and name not in left_out]
    joints = [
        joint
        for joint in m.joints.values()
        if not found.left_out.intersection(joint.bodies) and joint.kind.name not in SHAPELESS
    ]
    for joint in joints:
        if joint.kind.name not in JOINTS:
            raise UserError(
                f"{m.name}: joint '{joint.name}' is a {joint.kind.name.replace('_', ' ')}, and where bodies have "
                f"places z only {' and '.join(JOINTS)} joints have parts; leave one of its bodies out "
                f"(automatic(m).leave_out), take the places away, or write mechanisms/{m.name}/parts.py"
            )
    sliding = {joint.bodies[k]: joint for joint in joints for k in (0, 1) if _slides(joint, joint.bodies[k])}
    for body in bodies:
        own = [joint for joint in joints if body in joint.bodies]
        pins = [joint for joint in own if joint.kind.name == "revolute"]
        if body in sliding:
            continue
        mains = [joint for joint in pins if "ground" in joint.bodies]
        if mains and _is_shaft(m, body, pins):
            found.shafts[body] = _shaft(m, body, mains[0], pins)
        else:
            found.links[body] = _link(m, body, own, pins, sliding, chosen or {})
    for body, joint in sliding.items():
        if body in bodies:
            found.pistons[body] = _piston(found, body, joint, joints)
    return found


def _slides(joint: Joint, body: str) -> bool:
    """Whether ``body`` slides in a joint on ground."""
    return joint.kind.name == "prismatic" and body != "ground" and "ground" in joint.bodies


def _is_shaft(m: Mechanism, body: str, pins: list[Joint]) -> bool:
    """Whether its markers have places, its links lie in several planes, or it is driven and has no other place than
    they have.
    """
    ends = [(marker_on(joint, body), other_on(joint, body)) for joint in pins if "ground" not in joint.bodies]
    if any(own.z is not None for own, _ in ends) or len(planes(m, body)) > 1:
        return True
    z = m.bodies[body].z
    known = [mm(other.plane) for _, other in ends if other.plane is not None]
    driven = any(driver.kind.angular and set(driver.bodies) == {"ground", body} for driver in m.drivers.values())
    return driven and any(z is None or abs(own - mm(z)) < SAME for own in known)


def _shaft(m: Mechanism, body: str, main: Joint, pins: list[Joint]) -> Shaft:
    throws = []
    for joint in pins:
        if "ground" in joint.bodies:
            continue
        z = plane(joint, body)
        if z is None:
            raise _no_plane(m, joint.name, body)
        throws.append(Throw(joint.name, other_on(joint, body).body.name, *place(marker_on(joint, body)), z))
    throws.sort(key=lambda throw: throw.z)
    return Shaft(body, main.name, place(marker_on(main, body)), place(other_on(main, body)), tuple(throws))


def _no_plane(m: Mechanism, joint: str, body: str) -> UserError:
    return UserError(
        f"{m.name}: joint '{joint}' of '{body}' has no place z along the normal, and others have; give the body or the "
        f"marker one, such as m.body('{body}', z=0.02)"
    )


def free_links(m: Mechanism, left_out: Collection[str]) -> list[str]:
    """Links whose plane neither the model nor what they are pinned to tells."""
    joints = [joint for joint in m.joints.values() if not set(left_out).intersection(joint.bodies)]
    sliding = {body for joint in joints for body in joint.bodies if _slides(joint, body)}
    found = []
    for body in m.bodies:
        if body == "ground" or body in left_out or body in sliding or m.bodies[body].z is not None:
            continue
        pins = [joint for joint in joints if body in joint.bodies and joint.kind.name == "revolute"]
        is_shaft = any("ground" in joint.bodies for joint in pins) and _is_shaft(m, body, pins)
        if not is_shaft and not _told(body, pins, sliding):
            found.append(body)
    return found


def _told(body: str, pins: list[Joint], sliding: Collection[str]) -> list[float]:
    """Planes (mm) that markers tell, and the places of pistons."""
    found: list[float] = []
    for joint in pins:
        own, other = marker_on(joint, body), other_on(joint, body)
        z = own.z if own.z is not None else other.plane if other.body.name in sliding else other.z
        if z is not None and other.body.name != "ground" and all(abs(mm(z) - known) > SAME for known in found):
            found.append(mm(z))
    return found


def _link(
    m: Mechanism,
    body: str,
    own: list[Joint],
    pins: list[Joint],
    sliding: Collection[str],
    chosen: Mapping[str, float],
) -> Link:
    given = m.bodies[body].z
    slides = [joint.name for joint in own if joint.kind.name == "prismatic"]
    if slides:
        raise UserError(
            f"{m.name}: joint '{slides[0]}' lets '{body}' slide on a body that moves; where bodies have places z there "
            f"are guides on ground alone; leave '{body}' out (automatic(m).leave_out), or write "
            f"mechanisms/{m.name}/parts.py"
        )
    found = _told(body, pins, sliding)
    z = mm(given) if given is not None else found[0] if found else chosen.get(body)
    if z is None:
        raise UserError(
            f"{m.name}: '{body}' has no place z along the normal, and other bodies have; give it one, such as "
            f"m.body('{body}', z=0.02)"
        )
    apart = [other for other in found if abs(other - z) > SAME and given is None]
    if apart:
        raise UserError(
            f"{m.name}: joints of '{body}' lie in planes at z = {z:g} and {apart[0]:g} mm; only a body that turns on "
            f"ground can be a shaft through several planes; give '{body}' a z of its own, then it is a plate there and "
            "its pins reach to the others"
        )
    eyes = [LinkEye(joint.name, other_on(joint, body).body.name, *place(marker_on(joint, body))) for joint in pins]
    for x, y in _reached(m, body):
        if all(math.hypot(eye.x - x, eye.y - y) > NEAR for eye in eyes):
            eyes.append(LinkEye("", "", x, y))
    return Link(body, z, tuple(eyes))


def _reached(m: Mechanism, body: str) -> list[Point]:
    """Places that a link reaches without a joint there: both ends of a bar, and traced points."""
    length = m.bodies[body].length
    ends = [] if length is None else [(0.0, 0.0), (mm(length), 0.0)]
    return [*ends, *(place(marker) for marker in m.traces.values() if marker.body.name == body)]


def _piston(found: Machine, body: str, joint: Joint, joints: list[Joint]) -> Piston:
    m = found.m
    wrists = [j for j in joints if j.kind.name == "revolute" and body in j.bodies]
    zs = planes(m, body)
    own = m.bodies[body].z
    if len(wrists) > 1 or len(zs) > 1:
        raise UserError(
            f"{m.name}: '{body}' slides on ground in '{joint.name}' and carries {len(wrists)} pins "
            f"({', '.join(j.name for j in wrists)}); a piston has one; leave it out (automatic(m).leave_out) or write "
            f"mechanisms/{m.name}/parts.py"
        )
    z = mm(own) if own is not None else zs[0] if zs else None
    if z is None:
        raise _no_plane(m, joint.name, body)
    links = [found.links[end.body.name] for end in (other_on(j, body) for j in wrists) if end.body.name in found.links]
    apart = [link for link in links if abs(link.z - z) > SAME]
    if apart:
        raise UserError(
            f"{m.name}: '{body}' is at z = {z:g} mm and '{apart[0].body}' at {apart[0].z:g} mm in '{wrists[0].name}'; "
            "the rod of a piston is in its middle: give both the same z"
        )
    ground, mine = marker_on(joint, "ground"), marker_on(joint, body)
    theta = float(found.poses[body][0, 2])
    along = np.array([math.cos(ground.angle), math.sin(ground.angle)])
    wrist = place(marker_on(wrists[0], body)) if wrists else place(mine)
    link = other_on(wrists[0], body).body.name if wrists else None
    line = np.array(place(ground))
    origin = _driven_from(found, link, line)
    if float(((found.path(body, *wrist) - origin) @ along).mean()) < 0:
        along = -along
    left = np.array([-along[1], along[0]])
    aside = float((found.path(body, *wrist)[0] - line) @ left)
    turn = math.atan2(along[1], along[0]) - theta
    return Piston(
        body,
        joint.name,
        z,
        (float(along[0]), float(along[1])),
        (float(line[0]), float(line[1])),
        turn,
        wrist,
        aside,
        link,
        wrists[0].name if wrists else "",
        _area(m, body),
    )


def _driven_from(found: Machine, link: str | None, line: np.ndarray) -> np.ndarray:
    """Where the shaft is whose link moves a piston, on ground; the guide's own marker where there is none."""
    if link in found.links:
        for eye in found.links[link].eyes:
            if eye.on in found.shafts:
                return np.array(found.shafts[eye.on].at)
    return line


def _area(m: Mechanism, body: str) -> float | None:
    """Of the bore (mm^2), from a force of gas on the piston."""
    for force in m.forces.values():
        if body in force.bodies and "ground" in force.bodies:
            area = force.params.get("area")
            if isinstance(area, int | float) and area > 0:
                return float(area) * mm(1) ** 2
            bore = force.params.get("bore")
            if isinstance(bore, int | float) and bore > 0:
                return math.pi / 4 * mm(float(bore)) ** 2
    return None
