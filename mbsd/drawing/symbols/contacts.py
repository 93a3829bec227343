"""Signs of contacts: lines, terrains, discs, ropes and stops."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from mbsd.drawing.canvas import Canvas
from mbsd.drawing.carriers import on_body
from mbsd.drawing.look import INK, QUIET
from mbsd.drawing.pose import Pose
from mbsd.drawing.symbols.geometry import ROUND
from mbsd.drawing.symbols.surfaces import curve_way, draw_way
from mbsd.drawing.symbols.wheels import draw_disc, draw_span
from mbsd.model.joint import Joint

BEYOND = 3.0
"""Length of a floor beyond what touches it, in units."""
ALIKE = 1e-9
"""Lines whose places and directions differ by less (m, rad) are one line."""


def draw_contacts(canvas: Canvas, contacts: Sequence[Joint], pose: Pose, colours: dict[str, str]) -> None:
    """Draw every contact of a mechanism; feet on the same floor share its sign."""
    for feet in _floors(contacts):
        _floor(canvas, feet, pose, colours)
    for joint in contacts:
        if joint.kind.drawn_as in SIGNS:
            SIGNS[joint.kind.drawn_as](canvas, joint, pose, colours)


def contact_reach(joint: Joint, pose: Pose) -> np.ndarray:
    """Return (k, 2) points that a drawing of this contact must hold (m)."""
    i, j = pose.place(joint.i), pose.place(joint.j)
    out = [j + joint.params.get("radius", joint.params.get("radius_j", 0.0)) * ROUND]
    if joint.kind.touching == "line":
        ends = _travel(joint, pose)
        out.append(i + np.array([ends.min(), ends.max()])[:, None] * pose.axis(joint.i))
    elif joint.kind.touching == "curve":
        out.append(curve_way(joint, pose, f"contact {joint.name}"))
    elif joint.kind.touching == "discs":
        out.append(i + joint.params["radius_i"] * ROUND)
    elif joint.kind.drawn_as in ("rope", "slack_span"):
        out.append(i + joint.params.get("radius_i", 0.0) * ROUND)
    return np.concatenate(out)


def _travel(joint: Joint, pose: Pose) -> np.ndarray:
    """Return places of the second marker along the x axis of the first (m), over the motion and now."""
    here = float((pose.place(joint.j) - pose.place(joint.i)) @ pose.axis(joint.i))
    radius = joint.params.get("radius", 0.0)
    ways = np.append(pose.travel.get(f"contact {joint.name}", np.zeros(0)), here)
    return np.array([ways.min() - radius, ways.max() + radius])


def _floors(contacts: Sequence[Joint]) -> list[list[Joint]]:
    """Return contacts with lines, together where these are the same line of a body."""
    out: list[list[Joint]] = []
    for joint in contacts:
        if joint.kind.touching != "line":
            continue
        same = next((feet for feet in out if _same_line(feet[0], joint)), None)
        if same is None:
            out.append([joint])
        else:
            same.append(joint)
    return out


def _same_line(joint: Joint, other: Joint) -> bool:
    a, b = joint.i, other.i
    across = -(b.x - a.x) * math.sin(a.angle) + (b.y - a.y) * math.cos(a.angle)
    return a.body is b.body and abs(across) < ALIKE and abs(a.angle - b.angle) < ALIKE


def _floor(canvas: Canvas, feet: list[Joint], pose: Pose, colours: dict[str, str]) -> None:
    first, axis = pose.place(feet[0].i), pose.axis(feet[0].i)
    ends = np.concatenate([float((pose.place(foot.i) - first) @ axis) + _travel(foot, pose) for foot in feet])
    a, b = (first + way * axis for way in (ends.min() - BEYOND * canvas.unit, ends.max() + BEYOND * canvas.unit))
    name = feet[0].i.body.name
    with canvas.on(on_body(name)):
        if name == "ground":
            canvas.hatched(a, b, np.array([axis[1], -axis[0]]))
        else:
            canvas.line([a, b], colours.get(name, QUIET), 2.2, order=3.5)
        canvas.label(feet[0].name if len(feet) == 1 else f"{feet[0].name} ...", b, 0.5)


def _terrain(canvas: Canvas, joint: Joint, pose: Pose, colours: dict[str, str]) -> None:
    draw_way(canvas, curve_way(joint, pose, f"contact {joint.name}"), joint.i.body.name, colours)
    _disc(canvas, joint, pose, colours)


def _disc(canvas: Canvas, joint: Joint, pose: Pose, colours: dict[str, str]) -> None:
    """Draw the disc about marker j, unless a point touches."""
    name, radius = joint.j.body.name, joint.params.get("radius", 0.0)
    if radius > 0.0:
        turn = pose.frames[name][2] + joint.j.angle
        with canvas.on(on_body(name)):
            draw_disc(canvas, pose.place(joint.j), radius, turn, colours.get(name, QUIET))


def _discs(canvas: Canvas, joint: Joint, pose: Pose, colours: dict[str, str]) -> None:
    """Draw both discs, the outer one as a ring where the other is inside."""
    for marker, key in ((joint.i, "radius_i"), (joint.j, "radius_j")):
        name, centre, radius = marker.body.name, pose.place(marker), joint.params[key]
        colour = colours.get(name, QUIET)
        with canvas.on(on_body(name)):
            if joint.params["inside"] and marker is joint.i:
                turn = np.linspace(0.0, 2 * math.pi, 97)
                canvas.line(centre + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1), colour, 2.0, order=1.8)
            elif radius > 0.0:
                draw_disc(canvas, centre, radius, pose.frames[name][2] + marker.angle, colour)


def _coordinate_stop(canvas: Canvas, joint: Joint, pose: Pose, colours: dict[str, str]) -> None:
    """Draw a bar across the coordinate, where it ends."""
    axis, colour = pose.axis(joint.i), colours.get(joint.i.body.name, INK)
    end = pose.place(joint.i) + joint.params["at"] * axis
    across = 1.5 * canvas.unit * np.array([-axis[1], axis[0]])
    with canvas.on(on_body(joint.i.body.name)):
        canvas.line([end - across, end + across], colour, 3.0, order=4.2)


def _angle_stop(canvas: Canvas, joint: Joint, pose: Pose, colours: dict[str, str]) -> None:
    """Draw a spoke where the angle ends."""
    start, axis = pose.place(joint.i), pose.axis(joint.i)
    angle = math.atan2(axis[1], axis[0]) + joint.params["at"]
    out = canvas.unit * np.array([math.cos(angle), math.sin(angle)])
    with canvas.on(on_body(joint.i.body.name)):
        canvas.line([start + 1.2 * out, start + 2.6 * out], colours.get(joint.i.body.name, INK), 3.0, order=4.2)


def _rope_line(canvas: Canvas, joint: Joint, pose: Pose, colours: dict[str, str]) -> None:
    canvas.line(_rope(pose.place(joint.i), pose.place(joint.j), joint.params["length"]), INK, 1.5, order=5)


def _rope(i: np.ndarray, j: np.ndarray, length: float) -> np.ndarray:
    """Return (k, 2) of a rope: straight where taut, else a hanging parabola of its length."""
    gap = j - i
    distance = float(np.hypot(*gap))
    s = np.linspace(0.0, 1.0, 33)
    low, high = 0.0, length
    for _ in range(40 if distance < length * (1 - 1e-6) else 0):
        sag = 0.5 * (low + high)
        path = i + s[:, None] * gap - (4 * sag * s * (1 - s))[:, None] * np.array([0.0, 1.0])
        long = float(np.hypot(*np.diff(path, axis=0).T).sum()) > length
        low, high = (low, sag) if long else (sag, high)
    return i + s[:, None] * gap - (4 * low * s * (1 - s))[:, None] * np.array([0.0, 1.0])


SIGNS: dict[str, Callable[[Canvas, Joint, Pose, dict[str, str]], None]] = {
    "rigid_contact": _disc,
    "rigid_terrain": _terrain,
    "rigid_discs": _discs,
    "rope": _rope_line,
    "slack_span": draw_span,
    "coordinate_stop": _coordinate_stop,
    "angle_stop": _angle_stop,
}
