"""Signs of what rolls and slides on lines and curves: rack and pinion, discs, points on curves."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mbsd.drawing.canvas import Canvas
from mbsd.drawing.carriers import at_place, on_body
from mbsd.drawing.look import INK, PAPER, QUIET
from mbsd.drawing.symbols.reach import BESIDE
from mbsd.drawing.symbols.ways import curve_way, draw_way
from mbsd.drawing.symbols.wheels import FEWEST, PITCH, draw_disc, draw_gear, tooth, tooth_depth
from mbsd.model.body import Marker
from mbsd.model.teeth import with_radii

if TYPE_CHECKING:
    from mbsd.drawing.symbols.place import Place

MOST = 40
"""Teeth of a pinion."""
POINTS = 12
"""Number of points of a rack's outline for each tooth."""
BACK = 1.3
"""Depth of a rack behind its teeth, in units."""


def draw_rack(canvas: Canvas, place: Place) -> None:
    """A rack along the x axis of marker i, whose teeth mesh with those of the pinion about marker j."""
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
    along = np.linspace(a, b, max(2, math.ceil(POINTS * teeth * (b - a) / (2 * math.pi * radius))))
    height = -depth * tooth(teeth * (down + along / radius) - phase)
    back = BACK * u + depth
    outline = foot + along[:, None] * axis + height[:, None] * normal
    ends = [foot + b * axis - back * normal, foot + a * axis - back * normal]
    colour = place.colours.get(place.joint.i.body.name, QUIET)
    with canvas.on(on_body(place.joint.i.body.name)):
        canvas.shape(np.vstack([outline, ends]), edge=colour, fill=colour, width=1.3, order=1.8, alpha=0.12)
        canvas.line([foot + a * axis, foot + b * axis], colour, 0.7, order=1.9, linestyle=(0, (8, 2, 2, 2)))
        if place.joint.i.body.name == "ground":
            canvas.hatched(ends[1], ends[0], -normal)
    with canvas.on(on_body(name)):
        draw_gear(canvas, pinion, radius, teeth, phase, place.colours.get(name, QUIET), False)
    with canvas.on(at_place(place.joint.j)):
        canvas.label(place.joint.name, foot, 0.5)


def draw_rolling_disc(canvas: Canvas, place: Place) -> None:
    """A disc about marker j on the x axis of marker i."""
    radius, axis = place.joint.params["radius"], place.axis
    a, b = place.range(BESIDE * radius)
    draw_way(canvas, np.array([a, b]), place.joint.i.body.name, place.colours)
    _disc(canvas, place, radius)
    foot = place.i + float((place.j - place.i) @ axis) * axis
    with canvas.on(at_place(place.joint.j)):
        canvas.label(place.joint.name, foot, 0.6)


def draw_rolling_on_curve(canvas: Canvas, place: Place) -> None:
    """A disc about marker j on a curve fixed to marker i."""
    draw_way(canvas, _curve(place), place.joint.i.body.name, place.colours)
    _disc(canvas, place, place.joint.params["radius"])
    with canvas.on(at_place(place.joint.j)):
        canvas.label(place.joint.name, place.j, 0.6)


def draw_point_on_curve(canvas: Canvas, place: Place) -> None:
    """A point on a curve fixed to marker i, or a disc that slides beside it."""
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
