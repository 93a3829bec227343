"""Signs of gears, belts and cables: toothed outlines at the pitch circles, strands that touch the pulleys."""

from __future__ import annotations

import math

import numpy as np

from mbsd.drawing.canvas import Canvas
from mbsd.drawing.carriers import along_line, on_body
from mbsd.drawing.look import INK, QUIET
from mbsd.drawing.pose import Pose
from mbsd.model.cables import signed_radii, span_direction
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model
from mbsd.model.teeth import with_radii

PITCH = 1.25
"""Pitch of the teeth, in units; fewer than FEWEST are not drawn."""
FEWEST = 10
RIM = 1.5
"""Width of a ring beyond its teeth, in units."""


def draw_gear_pair(canvas: Canvas, joint: Joint | Force, pose: Pose, colours: dict[str, str]) -> None:
    """Draw both gears. A gear that is new on the canvas is turned until its teeth mesh with the other's."""
    internal = bool(joint.params.get("internal"))
    sized = with_radii(joint.params)
    r_i, r_j = sized["radius_i"], sized["radius_j"]
    i, j = pose.place(joint.i), pose.place(joint.j)
    line = math.atan2(*(j - i)[::-1])
    at_j = line if internal else line + math.pi  # where gear j is touched
    key_i, key_j = (joint.i.body.name, r_i), (joint.j.body.name, r_j)
    wheels, new_i, new_j = canvas.wheels, key_i not in canvas.wheels, key_j not in canvas.wheels
    known = {key: canvas.turned[key] for key in (key_i, key_j) if key in canvas.turned}
    wheels |= {key: place for key, place in known.items() if key not in wheels}
    if key_i in wheels and key_j in wheels:
        pass
    elif new_i and new_j and "teeth" in sized:
        wheels[key_i] = sized["teeth"][0], 0.0
    elif new_i and new_j:
        teeth = max(FEWEST, round(2 * math.pi * min(r_i, r_j) / (PITCH * canvas.unit)))
        wheels[key_i] = round(teeth * r_i / min(r_i, r_j)), 0.0
    if key_i in wheels and key_j in wheels:
        pass
    elif key_i in wheels:
        here = wheels[key_i][0] * line - wheels[key_i][1]  # phase of gear i's teeth at the contact
        teeth = max(3, round(wheels[key_i][0] * r_j / r_i))
        wheels.setdefault(key_j, (teeth, teeth * at_j + (math.pi - here if internal else here - math.pi)))
    else:
        here = wheels[key_j][0] * at_j - wheels[key_j][1]
        teeth = max(3, round(wheels[key_j][0] * r_i / r_j))
        wheels[key_i] = teeth, teeth * line - math.pi + (-here if internal else here)
    if new_i:
        with canvas.on(on_body(key_i[0])):
            draw_gear(canvas, i, r_i, *wheels[key_i], colours.get(key_i[0], QUIET), internal)
    if new_j:
        with canvas.on(on_body(key_j[0])):
            draw_gear(canvas, j, r_j, *wheels[key_j], colours.get(key_j[0], QUIET), False)
    with canvas.on(along_line(joint.i, joint.j)):
        canvas.label(joint.name, i + r_i * np.array([math.cos(line), math.sin(line)]), 0.5)


def ring_gear(m: Model, name: str) -> Joint | Force | None:
    """Return the mesh of which a body is the ring gear; None for other bodies."""
    internal = (joint for joint in (*m.joints.values(), *m.forces.values()) if joint.params.get("internal"))
    return next((joint for joint in internal if joint.i.body.name == name), None)


def rim_of(joint: Joint | Force, pose: Pose, unit: float) -> np.ndarray:
    """Return the place of a ring gear's name: at its rim."""
    away = (with_radii(joint.params)["radius_i"] + RIM * unit) * math.sqrt(0.5)
    return pose.place(joint.i) + away * np.array([-1.0, 1.0])


def tooth(phase: np.ndarray) -> np.ndarray:
    """Return the profile of teeth, -1 .. 1, a tooth at phase 0 (rad, 2 pi a tooth)."""
    return np.clip(1.8 * np.cos(phase), -1.0, 1.0)


def tooth_depth(canvas: Canvas, r: float, teeth: int) -> float:
    """Return half the height of the teeth of a gear (m)."""
    return 0.3 * min(2 * math.pi * r / teeth, PITCH * canvas.unit)


def draw_gear(canvas: Canvas, centre: np.ndarray, r: float, teeth: int, phase: float, colour: str, ring: bool) -> None:
    """Draw teeth at pitch radius r (m), one where ``teeth`` times angle is ``phase``; ``ring``: inside."""
    turn = np.linspace(0.0, 2 * math.pi, 8 * teeth + 1)
    depth = tooth_depth(canvas, r, teeth)
    profile = tooth(teeth * turn - phase) * (-1.0 if ring else 1.0)
    outline = centre + (r + depth * profile)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    if ring:
        rim = centre + (r + RIM * canvas.unit) * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        canvas.band(rim, outline, colour)
        return
    canvas.shape(outline[:-1], edge=colour, fill=colour, width=1.3, order=1.8, alpha=0.12)
    pitch_circle = centre + r * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    canvas.line(pitch_circle, colour, 0.7, order=1.9, dash=(8, 2, 2, 2))


def draw_disc(canvas: Canvas, centre: np.ndarray, radius: float, angle: float, colour: str) -> None:
    """Draw a disc with a spoke that shows how it is turned (rad)."""
    turn = np.linspace(0.0, 2 * math.pi, 73)[:-1]
    ring = centre + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    canvas.shape(ring, edge=colour, fill=colour, width=1.3, order=1.8, alpha=0.12)
    tip = centre + radius * np.array([math.cos(angle), math.sin(angle)])
    canvas.line([centre, tip], colour, 1.0, order=1.9)


def draw_belt(canvas: Canvas, joint: Joint, pose: Pose, colours: dict[str, str]) -> None:
    """Draw two pulleys and the strands."""
    ends = []
    for marker, key in ((joint.i, "radius_i"), (joint.j, "radius_j")):
        centre, radius = pose.place(marker), with_radii(joint.params)[key]
        with canvas.on(on_body(marker.body.name)):
            draw_disc(canvas, centre, radius, pose.frames[marker.body.name][2], colours.get(marker.body.name, QUIET))
        ends.append((centre, radius))
    (i, r_i), (j, r_j) = ends
    gap = j - i
    length = float(np.hypot(*gap))
    other = -r_j if joint.params.get("crossed") else r_j
    with canvas.on(along_line(joint.i, joint.j)):
        if length > abs(r_i - other):
            line, lean = math.atan2(gap[1], gap[0]), math.acos((r_i - other) / length)
            for side in (1, -1):
                normal = np.array([math.cos(line + side * lean), math.sin(line + side * lean)])
                canvas.line([i + r_i * normal, j + other * normal], INK, 1.8, order=3)
        canvas.label(joint.name, (i + j) / 2, 0.6)


def draw_span(canvas: Canvas, joint: Joint, pose: Pose, colours: dict[str, str]) -> None:
    """Draw a span of a cable from wheel to wheel, and those of its wheels that are not yet on the canvas."""
    signed = signed_radii(joint.params)
    ends = [pose.place(marker) for marker in (joint.i, joint.j)]
    for marker, centre, radius in zip((joint.i, joint.j), ends, signed, strict=True):
        key = marker.body.name, marker.x, marker.y, abs(radius)
        if radius == 0.0 or key in canvas.pulleys:
            continue
        canvas.pulleys.add(key)
        with canvas.on(on_body(marker.body.name)):
            angle = pose.frames[marker.body.name][2]
            draw_disc(canvas, centre, abs(radius), angle, colours.get(marker.body.name, QUIET))
    along = float(span_direction(ends[1] - ends[0], signed))
    left = np.array([-math.sin(along), math.cos(along)])
    ends = [centre - radius * left for centre, radius in zip(ends, signed, strict=True)]
    canvas.line(ends, INK, 1.8, order=5)
    canvas.label(joint.name, (ends[0] + ends[1]) / 2, 0.5)
