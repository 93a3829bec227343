"""Signs of higher pairs: rack and pinion, discs and points on curves, cams, Genevas."""

from __future__ import annotations

import math

import numpy as np

from mbsd.drawing.canvas import Canvas
from mbsd.drawing.carriers import at_place, on_body
from mbsd.drawing.look import INK, PAPER, QUIET
from mbsd.drawing.symbols.geometry import BESIDE, Place, geneva_radius, placed, profile_of
from mbsd.drawing.symbols.surfaces import curve_way, draw_way
from mbsd.drawing.symbols.wheels import FEWEST, PITCH, draw_disc, draw_gear, tooth, tooth_depth
from mbsd.model.body import Marker
from mbsd.model.teeth import with_radii

MOST = 40
"""Teeth of a pinion."""
RACK_POINTS = 12
"""Number of points of a rack's outline for each tooth."""
BACK = 1.3
"""Depth of a rack behind its teeth, in units."""


def draw_rack(canvas: Canvas, place: Place) -> None:
    """Draw a rack along the x axis of marker i, whose teeth mesh with those of the pinion about marker j."""
    sized, u, axis = with_radii(place.joint.params), canvas.unit, place.axis
    radius = sized["radius"]
    normal = np.array([-axis[1], axis[0]])
    pinion, name = place.j, place.joint.j.body.name
    fitting = sized.get("teeth", min(max(FEWEST, round(2 * math.pi * radius / (PITCH * u))), MOST))
    teeth, phase = canvas.wheels.setdefault((name, radius), canvas.turned.get((name, radius), (fitting, 0.0)))
    down = math.atan2(-normal[1], -normal[0])  # where the pinion touches, as an angle
    depth = tooth_depth(canvas, radius, teeth)
    foot = place.i + float((pinion - place.i) @ axis) * axis
    a, b = (float((end - foot) @ axis) for end in place.range(BESIDE * radius))
    along = np.linspace(a, b, max(2, math.ceil(RACK_POINTS * teeth * (b - a) / (2 * math.pi * radius))))
    height = -depth * tooth(teeth * (down + along / radius) - phase)
    back = BACK * u + depth
    outline = foot + along[:, None] * axis + height[:, None] * normal
    ends = [foot + b * axis - back * normal, foot + a * axis - back * normal]
    colour = place.colours.get(place.joint.i.body.name, QUIET)
    with canvas.on(on_body(place.joint.i.body.name)):
        canvas.shape(np.vstack([outline, ends]), edge=colour, fill=colour, width=1.3, order=1.8, alpha=0.12)
        canvas.line([foot + a * axis, foot + b * axis], colour, 0.7, order=1.9, dash=(8, 2, 2, 2))
        if place.joint.i.body.name == "ground":
            canvas.hatched(ends[1], ends[0], -normal)
    with canvas.on(on_body(name)):
        draw_gear(canvas, pinion, radius, teeth, phase, place.colours.get(name, QUIET), False)
    with canvas.on(at_place(place.joint.j)):
        canvas.label(place.joint.name, foot, 0.5)


def draw_rolling_disc(canvas: Canvas, place: Place) -> None:
    """Draw a disc about marker j on the x axis of marker i."""
    radius, axis = place.joint.params["radius"], place.axis
    a, b = place.range(BESIDE * radius)
    draw_way(canvas, np.array([a, b]), place.joint.i.body.name, place.colours)
    _disc(canvas, place, radius)
    foot = place.i + float((place.j - place.i) @ axis) * axis
    with canvas.on(at_place(place.joint.j)):
        canvas.label(place.joint.name, foot, 0.6)


def draw_rolling_on_curve(canvas: Canvas, place: Place) -> None:
    """Draw a disc about marker j on a curve fixed to marker i."""
    draw_way(canvas, _curve(place), place.joint.i.body.name, place.colours)
    _disc(canvas, place, place.joint.params["radius"])
    with canvas.on(at_place(place.joint.j)):
        canvas.label(place.joint.name, place.j, 0.6)


def draw_point_on_curve(canvas: Canvas, place: Place) -> None:
    """Draw a point on a curve fixed to marker i, or a disc that slides beside it."""
    path = _curve(place)
    ground = place.joint.i.body.name == "ground"
    with canvas.on(on_body(place.joint.i.body.name)):
        canvas.line(path, INK if ground else place.colours[place.joint.i.body.name], 1.6, order=3.5)
        if ground:
            middle = len(path) // 2
            along = path[middle] - path[middle - 1]
            along = along / float(np.hypot(*along)) * canvas.unit
            canvas.hatched(path[middle] - along, path[middle] + along, np.array([along[1], -along[0]]) / canvas.unit)
    distance = abs(place.joint.params["distance"])
    with canvas.on(at_place(place.joint.j)):
        if distance > 0.0:
            canvas.circle(place.j, distance / canvas.unit, order=1.8, width=1.2, alpha=0.0)
        canvas.circle(place.j, 0.45, fill=PAPER, order=8, width=1.4)
        canvas.label(place.joint.name, place.j, 0.8)


def _disc(canvas: Canvas, place: Place, radius: float) -> None:
    marker: Marker = place.joint.j
    colour = place.colours.get(marker.body.name, QUIET)
    with canvas.on(on_body(marker.body.name)):
        draw_disc(canvas, place.j, radius, place.pose.frames[marker.body.name][2], colour)


def _curve(place: Place) -> np.ndarray:
    return curve_way(place.joint, place.pose, place.joint.name)


OUTLINE_POINTS = 240
"""Number of points of the outline at most."""


def draw_cam(canvas: Canvas, place: Place) -> None:
    """Draw the disc at marker i, and a roller about marker j or a face along its x axis."""
    joint = place.joint
    profile = profile_of(joint.params)
    outline = profile.outline[:: max(1, len(profile.outline) // OUTLINE_POINTS)]
    colour = place.colours.get(joint.i.body.name, QUIET)
    turn = np.linspace(0.0, 2 * math.pi, 73)
    circle = profile.sizes["base_radius"] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    with canvas.on(on_body(joint.i.body.name)):
        canvas.shape(placed(place.pose, joint.i, outline), edge=colour, fill=colour, width=1.5, order=1.8, alpha=0.14)
        canvas.line(place.i + circle, colour, 0.7, order=1.9, dash=(8, 2, 2, 2))
    follower = place.colours.get(joint.j.body.name, QUIET)
    if profile.flat:
        axis = place.pose.axis(joint.j)
        foot = place.j + float((place.i - place.j) @ axis) * axis
        half = 0.8 * float(np.hypot(*outline.T).max())
        canvas.line([foot - half * axis, foot + half * axis], follower, 3.0, order=4)
        with canvas.on(at_place(joint.j)):
            canvas.label(joint.name, foot + half * axis, 0.4)
        return
    radius = profile.sizes["roller_radius"]
    with canvas.on(at_place(joint.j)):
        canvas.circle(place.j, radius / canvas.unit, edge=follower, fill=PAPER, width=1.5, order=4)
        canvas.circle(place.j, min(0.3, 0.4 * radius / canvas.unit), edge=follower, fill=PAPER, width=1.2, order=8)
        canvas.label(joint.name, place.j, radius / canvas.unit + 0.3)


LOCK = 0.8
"""Radius of the locking disc, of that of the pin's circle."""
PIN, WIDE = 0.5, 0.6
"""Radius of the pin and half width of a slot, in units, if the wheel has room for them."""


def draw_geneva(canvas: Canvas, place: Place) -> None:
    """Draw the wheel, and over it the crank with its pin and locking disc."""
    joint, u = place.joint, canvas.unit
    slots, radius = joint.params["slots"], joint.params["radius"]
    distance = float(np.hypot(*(place.j - place.i)))
    rim = geneva_radius(joint, place.pose)
    wide = min(WIDE * u, 0.25 * rim * math.sin(math.pi / slots))
    wheel = place.colours.get(joint.j.body.name, QUIET)
    outline = _wheel(slots, distance, radius, rim, wide)
    with canvas.on(on_body(joint.j.body.name)):
        canvas.shape(placed(place.pose, joint.j, outline), edge=wheel, fill=wheel, width=1.4, order=1.8, alpha=0.14)
    crank = place.colours.get(joint.i.body.name, QUIET)
    lock = placed(place.pose, joint.i, _lock(slots, distance - rim, LOCK * radius))
    pin = place.i + radius * place.axis
    with canvas.on(on_body(joint.i.body.name)):
        canvas.shape(lock, edge=crank, fill=crank, width=1.2, order=1.9, alpha=0.14)
        canvas.line([place.i, pin], crank, 3.0, order=3)
        canvas.circle(pin, wide / u * PIN / WIDE, edge=crank, fill=PAPER, width=1.4, order=8)
        canvas.label(joint.name, pin, 0.7)


def _wheel(slots: int, distance: float, radius: float, rim: float, wide: float) -> np.ndarray:
    """Return (k, 2) outline with a slot along the x axis and locking arcs between the slots."""
    lock = LOCK * radius
    edge = math.asin(wide / rim)
    bottom = distance - radius
    half = np.linspace(-math.pi / 2, math.pi / 2, 9)
    slot = np.stack([bottom - wide * np.cos(half), -wide * np.sin(half)], axis=1)
    angles = np.linspace(edge, 2 * math.pi / slots - edge, 49)
    off = angles - math.pi / slots
    inside = lock**2 - (distance * np.sin(off)) ** 2
    arc = distance * np.cos(off) - np.sqrt(np.maximum(inside, 0.0))
    reach = np.where((inside > 0) & (arc < rim), arc, rim)
    between = reach[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    tooth = np.vstack([slot[::-1], between])
    turns = 2 * math.pi / slots * np.arange(slots)
    return np.vstack([tooth @ np.array([[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]]) for a in turns])


def _lock(slots: int, room: float, lock: float) -> np.ndarray:
    """Return (k, 2) outline of the locking disc, cut away for the wheel's tips.

    It is cut towards the pin, the x axis.
    """
    half = math.pi / 2 - math.pi / slots
    arc = np.linspace(half, 2 * math.pi - half, 61)
    rim = lock * np.stack([np.cos(arc), np.sin(arc)], axis=1)
    s = np.linspace(-1.0, 1.0, 21)[:, None]
    deep = 0.8 * min(room, 0.8 * lock * math.cos(half))
    ends = lock * np.array([math.cos(half), math.sin(half)])
    cut = np.hstack([deep + (ends[0] - deep) * s**2, ends[1] * s])
    return np.vstack([rim, cut[1:-1]])
