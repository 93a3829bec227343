"""Bodies that slide along a line of ground: pistons, rams that are driven in several planes, valves under cams (mm)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.shafts.bodies.kinds import Piston, Ram, RamPin, Valve
from mechanisms.stages.automatic.shafts.bodies.planes import SAME, marker_on, no_plane, other_on, place, plane, planes
from shared.shapes.units import mm
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mbsd import Mechanism
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.shafts.bodies.kinds import Machine


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
    theta = float(machine.poses[body][0, 2])
    along = np.array([math.cos(ground.angle), math.sin(ground.angle)])
    wrist = place(marker_on(wrists[0], body)) if wrists else place(mine)
    link = other_on(wrists[0], body).body.name if wrists else None
    line = np.array(place(ground))
    origin = _driven_from(machine, link, line)
    if float(((machine.path(body, *wrist) - origin) @ along).mean()) < 0:
        along = -along
    left = np.array([-along[1], along[0]])
    aside = float((machine.path(body, *wrist)[0] - line) @ left)
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


def ram(machine: Machine, body: str, joint: Joint, wrists: Sequence[Joint]) -> Ram:
    """Tell a ram. Raises UserError naming a pin that is not one of a link in a plane."""
    m = machine.m
    for wrist in wrists:
        other = other_on(wrist, body).body.name
        if other not in machine.links:
            raise UserError(
                f"{m.name}: '{body}' slides on ground in '{joint.name}' and is driven by several bodies, of which "
                f"'{other}' in '{wrist.name}' is no link; leave it out (automatic(m).leave_out) or write "
                f"{shown_file(m.name, 'parts')}"
            )
    ground = marker_on(joint, "ground")
    along = np.array([math.cos(ground.angle), math.sin(ground.angle)])
    line = np.array(place(ground))
    paths = [machine.path(body, *place(marker_on(wrist, body))) for wrist in wrists]
    links = [machine.links[other_on(wrist, body).body.name] for wrist in wrists]
    ends = [machine.path(link.body, eye.x, eye.y) for link in links for eye in link.eyes if eye.on not in ("", body)]
    behind = np.mean([end.mean(axis=0) for end in ends], axis=0) if ends else line
    if sum(float(((path - behind) @ along).mean()) for path in paths) < 0:
        along = -along
    left = np.array([-along[1], along[0]])
    turn = math.atan2(along[1], along[0]) - float(machine.poses[body][0, 2])
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
    return Ram(
        body,
        joint.name,
        (float(along[0]), float(along[1])),
        (float(line[0]), float(line[1])),
        turn,
        (x + s * q, y - c * q),
        tuple(pins),
        float(travel.min()),
        float(travel.max()),
    )


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
    return Valve(
        body,
        joint.name,
        cam.name,
        other_on(cam, body).body.name,
        z,
        (float(along[0]), float(along[1])),
        normal - theta,
        place(face),
        (float(path[least, 0]), float(path[least, 1])),
        float(np.ptp(pushed)),
    )


def _driven_from(machine: Machine, link: str | None, line: np.ndarray) -> np.ndarray:
    """Where the shaft is whose link moves a piston, also by a rod in the plane of another; else the guide's marker."""
    if link in machine.links:
        own = machine.links[link]
        others = [machine.links[eye.on] for eye in own.eyes if eye.on in machine.links]
        for rod in [own, *(other for other in others if abs(other.z - own.z) < SAME)]:
            for eye in rod.eyes:
                if eye.on in machine.shafts:
                    return np.array(machine.shafts[eye.on].at)
    return line


def _area(m: Mechanism, body: str) -> float | None:
    """Area of the bore (mm^2), from a force of gas on the piston."""
    for force in m.forces.values():
        if body in force.bodies and "ground" in force.bodies:
            area = force.params.get("area")
            if isinstance(area, int | float) and area > 0:
                return float(area) * mm(1) ** 2
            bore = force.params.get("bore")
            if isinstance(bore, int | float) and bore > 0:
                return math.pi / 4 * mm(float(bore)) ** 2
    return None
