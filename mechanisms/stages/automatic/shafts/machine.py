"""The machine that a model describes: its shaft, rods, pistons and slides."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence

import numpy as np

from mbsd import Mechanism
from mbsd.model.body import Marker
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.shafts.bodies import (
    NEAR,
    SAME,
    Link,
    LinkEye,
    Machine,
    Piston,
    Point,
    Ram,
    RamPin,
    Shaft,
    Throw,
    Valve,
    marker_on,
    no_plane,
    other_on,
    place,
    plane,
    planes,
)
from shared.shapes.units import mm
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Bodies that slide along a line of ground: pistons, rams that are driven in several planes, valves under cams (mm).


def piston(machine: Machine, body: str, joint: Joint, joints: list[Joint]) -> Piston:
    """Tell a piston. Raises UserError for several pins, for no plane, and for a rod beside it."""
    m = machine.m
    wrists = [j for j in joints if j.kind.name == "revolute" and body in j.bodies]
    zs = planes(m, body)
    own = m.bodies[body].z
    if len(wrists) > 1 or len(zs) > 1:
        raise UserError(
            f"{m.name}: '{body}' slides on ground in '{joint.name}' and carries {len(wrists)} pins "
            f"({', '.join(j.name for j in wrists)}); a piston has one; leave it out (automatic(m).leave_out) or write "
            f"{shown_file(m.name, 'parts')}"
        )
    z = mm(own) if own is not None else zs[0] if zs else None
    if z is None:
        raise no_plane(m, joint.name, body)
    links = [
        machine.links[end.body.name] for end in (other_on(j, body) for j in wrists) if end.body.name in machine.links
    ]
    apart = [link for link in links if abs(link.z - z) > SAME]
    if apart:
        raise UserError(
            f"{m.name}: '{body}' is at z = {z:g} mm and '{apart[0].body}' at {apart[0].z:g} mm in '{wrists[0].name}'; "
            "the rod of a piston is in its middle: give both the same z"
        )
    ground, mine = marker_on(joint, "ground"), marker_on(joint, body)
    wrist = place(marker_on(wrists[0], body)) if wrists else place(mine)
    link = other_on(wrists[0], body).body.name if wrists else None
    line, path = np.array(place(ground)), machine.path(body, *wrist)
    along, left = _guide(ground, [path], _driven_from(machine, link, line))
    aside = float((path[0] - line) @ left)
    way = body, joint.name, _point(along), _turn(machine, body, along)
    return Piston(*way, z, _point(line), wrist, aside, link, _area(m, body))


def ram(machine: Machine, body: str, joint: Joint, wrists: Sequence[Joint]) -> Ram:
    """Tell a ram. Raises UserError naming a pin that is not one of a link in a plane."""
    m = machine.m
    for wrist in wrists:
        other = other_on(wrist, body).body.name
        if other not in machine.links:
            raise UserError(
                f"{m.name}: '{body}' slides on ground in '{joint.name}' and is driven by several bodies; "
                f"'{other}' in '{wrist.name}' is no link; leave '{body}' out (automatic(m).leave_out) or write "
                f"{shown_file(m.name, 'parts')}"
            )
    ground = marker_on(joint, "ground")
    line = np.array(place(ground))
    paths = [machine.path(body, *place(marker_on(wrist, body))) for wrist in wrists]
    links = [machine.links[other_on(wrist, body).body.name] for wrist in wrists]
    ends = [machine.path(link.body, eye.x, eye.y) for link in links for eye in link.eyes if eye.on not in ("", body)]
    behind = np.mean([end.mean(axis=0) for end in ends], axis=0) if ends else line
    along, left = _guide(ground, paths, behind)
    turn = _turn(machine, body, along)
    first = min(range(len(wrists)), key=lambda k: links[k].z)
    s0 = float((paths[first][0] - line) @ along)
    pins = [
        RamPin(wrist.name, link.body, float((path[0] - line) @ along) - s0, float((path[0] - line) @ left), link.z)
        for wrist, link, path in zip(wrists, links, paths, strict=True)
    ]
    pins.sort(key=lambda pin: pin.z)
    x, y = place(marker_on(wrists[first], body))
    c, s = math.cos(turn), math.sin(turn)
    q = pins[0].q
    travel = (paths[first] - line) @ along
    origin = x + s * q, y - c * q
    way = body, joint.name, _point(along), turn
    return Ram(*way, _point(line), origin, tuple(pins), float(travel.min()), float(travel.max()))


def valve(machine: Machine, body: str, joint: Joint, cam: Joint) -> Valve:
    """Tell a valve, which slides in ``joint``. Raises UserError where it carries pins or lies in no plane."""
    m = machine.m
    z = plane(cam, body)
    if z is None:
        raise no_plane(m, cam.name, body)
    more = [other.name for other in m.joints.values() if body in other.bodies and other not in (joint, cam)]
    if more:
        raise UserError(
            f"{m.name}: '{body}' is pushed by a cam in '{cam.name}' and has '{more[0]}' besides; where bodies have "
            f"places z a valve has its guide and its cam alone; leave it out (automatic(m).leave_out) or write "
            f"{shown_file(m.name, 'parts')}"
        )
    face = marker_on(cam, body)
    theta = float(machine.poses[body][0, 2])
    normal = theta + face.angle + math.pi / 2
    along = np.array([math.cos(normal), math.sin(normal)])
    path = machine.path(body, *place(face))
    pushed = path @ along
    least = int(np.argmin(pushed))
    shaft, closed = other_on(cam, body).body.name, _point(path[least])
    way = body, joint.name, _point(along), normal - theta
    return Valve(*way, cam.name, shaft, z, place(face), closed, float(np.ptp(pushed)))


def _point(place: np.ndarray) -> Point:
    return float(place[0]), float(place[1])


def _turn(machine: Machine, body: str, along: np.ndarray) -> float:
    """Return the direction of ``along`` (2,), on ground, in the frame of a body at the start (rad)."""
    return math.atan2(along[1], along[0]) - float(machine.poses[body][0, 2])


def _guide(ground: Marker, paths: Sequence[np.ndarray], behind: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return unit vectors along a guide and to the left of that.

    Places with ``paths`` (T, 2) lie ahead of one ``behind``.
    """
    along = np.array([math.cos(ground.angle), math.sin(ground.angle)])
    if sum(float(((path - behind) @ along).mean()) for path in paths) < 0:
        along = -along
    return along, np.array([-along[1], along[0]])


def _driven_from(machine: Machine, link: str | None, line: np.ndarray) -> np.ndarray:
    """Return where the shaft is whose link moves a piston, else the guide's marker.

    The link may move it by a rod in the plane of another.
    """
    if link in machine.links:
        own = machine.links[link]
        others = [machine.links[eye.on] for eye in own.eyes if eye.on in machine.links]
        for rod in [own, *(other for other in others if abs(other.z - own.z) < SAME)]:
            for eye in rod.eyes:
                if eye.on in machine.shafts:
                    return np.array(machine.shafts[eye.on].at)
    return line


def _area(m: Mechanism, body: str) -> float | None:
    """Return the area of the bore (mm^2), from a force of gas on the piston."""
    for force in m.forces.values():
        if body in force.bodies and "ground" in force.bodies:
            area = force.params.get("area")
            if isinstance(area, int | float) and area > 0:
                return float(area) * mm(1) ** 2
            bore = force.params.get("bore")
            if isinstance(bore, int | float) and bore > 0:
                return math.pi / 4 * mm(float(bore)) ** 2
    return None


# Roles of bodies with places along the normal: a shaft, a link in one plane, or a body that slides (mm).

WHEELS = ("gear_pair", "belt")
CAM = "cam_flat"
JOINTS = ("revolute", "prismatic", *WHEELS, CAM)
"""Kinds of joints that have parts where bodies have places along the normal."""
SHAPELESS = ("angle_lock", "constraint", "turn_ratio", "travel_ratio")


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
    assembled = Machine(m, poses, times, left_out=frozenset(left_out))
    bodies = [name for name in m.bodies if name != "ground" and name not in left_out]
    joints = [
        joint
        for joint in m.joints.values()
        if not assembled.left_out.intersection(joint.bodies) and joint.kind.name not in SHAPELESS
    ]
    for joint in joints:
        if joint.kind.name not in JOINTS:
            raise UserError(
                f"{m.name}: joint '{joint.name}' is a {joint.kind.name.replace('_', ' ')}, and where bodies have "
                f"places z only {', '.join(JOINTS)} joints have parts; leave one of its bodies out "
                f"(automatic(m).leave_out), take the places away, or write {shown_file(m.name, 'parts')}"
            )
    sliding = {joint.bodies[k]: joint for joint in joints for k in (0, 1) if _slides(joint, joint.bodies[k])}
    cams = _cams(m, joints, sliding)
    for body in bodies:
        own = [joint for joint in joints if body in joint.bodies]
        pins = [joint for joint in own if joint.kind.name == "revolute"]
        if body in sliding:
            continue
        mains = [joint for joint in pins if "ground" in joint.bodies]
        if mains and (body in _wheeled(joints) or _is_shaft(m, body, pins)):
            assembled.shafts[body] = _shaft(m, body, mains[0], pins)
        else:
            assembled.links[body] = _link(m, body, own, pins, _pistons(sliding, joints), chosen or {})
    for body, joint in sliding.items():
        if body in cams:
            assembled.valves[body] = valve(assembled, body, joint, cams[body])
        elif body in bodies and body in _pistons(sliding, joints):
            assembled.pistons[body] = piston(assembled, body, joint, joints)
        elif body in bodies:
            assembled.rams[body] = ram(assembled, body, joint, _pins_of(body, joints))
    return assembled


def _cams(m: Mechanism, joints: Collection[Joint], sliding: Collection[str]) -> dict[str, Joint]:
    """Return joints with cams by the body that is pushed.

    Raises UserError where that does not slide on ground.
    """
    cams = {}
    for joint in joints:
        if joint.kind.name != CAM:
            continue
        body = joint.j.body.name
        if body not in sliding:
            raise UserError(
                f"{m.name}: the cam of '{joint.name}' pushes '{body}', which does not slide on ground; where bodies "
                f"have places z cams push valves on ground alone; leave '{body}' out (automatic(m).leave_out), or "
                f"write {shown_file(m.name, 'parts')}"
            )
        cams[body] = joint
    return cams


def _wheeled(joints: Collection[Joint]) -> set[str]:
    """Return bodies with wheels and cams."""
    wheeled = {body for joint in joints if joint.kind.name in WHEELS for body in joint.bodies}
    return wheeled | {joint.i.body.name for joint in joints if joint.kind.name == CAM}


def _pins_of(body: str, joints: Collection[Joint]) -> list[Joint]:
    return [joint for joint in joints if joint.kind.name == "revolute" and body in joint.bodies]


def _pistons(sliding: Collection[str], joints: Collection[Joint]) -> set[str]:
    """Return bodies that slide on ground with one pin at most.

    What has more is a ram, and gives links no plane.
    """
    return {body for body in sliding if len(_pins_of(body, joints)) < 2}


def _slides(joint: Joint, body: str) -> bool:
    """Return True if ``body`` slides in a joint on ground."""
    return joint.kind.name == "prismatic" and body != "ground" and "ground" in joint.bodies


def _is_shaft(m: Mechanism, body: str, pins: list[Joint]) -> bool:
    """Return True for a body whose markers have places or whose links lie in several planes.

    Also for one that is driven and has no other place than they have.
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
            raise no_plane(m, joint.name, body)
        throws.append(Throw(joint.name, other_on(joint, body).body.name, *place(marker_on(joint, body)), z))
    throws.sort(key=lambda throw: throw.z)
    return Shaft(body, main.name, place(marker_on(main, body)), place(other_on(main, body)), tuple(throws))


def free_links(m: Mechanism, left_out: Collection[str]) -> list[str]:
    """Return links whose plane neither the model nor what they are pinned to gives."""
    joints = [joint for joint in m.joints.values() if not set(left_out).intersection(joint.bodies)]
    sliding = {body for joint in joints for body in joint.bodies if _slides(joint, body)}
    free = []
    for body in m.bodies:
        if body == "ground" or body in left_out or body in sliding or m.bodies[body].z is not None:
            continue
        pins = [joint for joint in joints if body in joint.bodies and joint.kind.name == "revolute"]
        is_shaft = any("ground" in joint.bodies for joint in pins) and (
            body in _wheeled(joints) or _is_shaft(m, body, pins)
        )
        if not is_shaft and not _known_planes(body, pins, _pistons(sliding, joints)):
            free.append(body)
    return free


def _known_planes(body: str, pins: list[Joint], sliding: Collection[str]) -> list[float]:
    """Return planes (mm) that markers give, and the places of pistons."""
    places: list[float] = []
    for joint in pins:
        own, other = marker_on(joint, body), other_on(joint, body)
        z = own.z if own.z is not None else other.plane if other.body.name in sliding else other.z
        if z is not None and other.body.name != "ground" and all(abs(mm(z) - known) > SAME for known in places):
            places.append(mm(z))
    return places


def _link(
    m: Mechanism, body: str, own: list[Joint], pins: list[Joint], sliding: Collection[str], chosen: Mapping[str, float]
) -> Link:
    given = m.bodies[body].z
    slides = [joint.name for joint in own if joint.kind.name == "prismatic"]
    if slides:
        raise UserError(
            f"{m.name}: joint '{slides[0]}' guides '{body}' on a body that moves; where bodies have places z, "
            f"guides are on ground alone; leave '{body}' out (automatic(m).leave_out), or write "
            f"{shown_file(m.name, 'parts')}"
        )
    places = _known_planes(body, pins, sliding)
    z = mm(given) if given is not None else places[0] if places else chosen.get(body)
    if z is None:
        raise UserError(
            f"{m.name}: '{body}' has no place z along the normal, and other bodies have; give it one, such as "
            f"m.body('{body}', z=0.02)"
        )
    apart = [other for other in places if abs(other - z) > SAME and given is None]
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
    """Return places that a link reaches without a joint there: both ends of a bar, and traced points."""
    length = m.bodies[body].length
    ends = [] if length is None else [(0.0, 0.0), (mm(length), 0.0)]
    return [*ends, *(place(marker) for marker in m.traces.values() if marker.body.name == body)]
