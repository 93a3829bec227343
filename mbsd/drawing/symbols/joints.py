"""Standard symbols of joints and drivers: pin circle, slider on its guide, slot, weld, rod, arrows.

Those of gears and belts are in wheels.py, of cams, Genevas and what rolls in higher_pairs.py.

A kind that has no symbol of its own here gets a dashed line between its markers, so nothing is left out.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mbsd.drawing.canvas import Canvas
from mbsd.drawing.carriers import GROUND, along_axes, along_line, at_place, on_body
from mbsd.drawing.look import INK, MOVED, PAPER, QUIET, WRONG
from mbsd.drawing.symbols.geometry import Place, rounded
from mbsd.drawing.symbols.higher_pairs import (
    draw_cam,
    draw_geneva,
    draw_point_on_curve,
    draw_rack,
    draw_rolling_disc,
    draw_rolling_on_curve,
)
from mbsd.drawing.symbols.wheels import draw_belt, draw_gear_pair, draw_span

PIN = 0.62
"""Radius of a pin, in units."""
BLOCK = (1.75, 1.05)
"""Half length and half height of a slider block, in units."""


def draw_joint(canvas: Canvas, place: Place) -> None:
    """Draw the symbol of a joint or driver, and its name."""
    SYMBOLS.get(place.joint.kind.drawn_as, _link)(canvas, place)


def _revolute(canvas: Canvas, place: Place) -> None:
    centre = place.j
    if place.grounded:
        _support(canvas, place.grounded_end, place.free_side)
    with canvas.on(place.carrier):
        canvas.circle(centre, PIN, order=8, width=1.5)
        _open(canvas, place)
        canvas.label(place.joint.name, centre, PIN + 0.35)


def _support(canvas: Canvas, pin: np.ndarray, side: np.ndarray) -> None:
    """Draw ground under a pin: a triangle on a hatched line, once where several pins share a place."""
    if any(float(np.hypot(*(pin - other))) < 0.2 * canvas.unit for other in canvas.supports):
        return
    canvas.supports.append(pin)
    across = np.array([-side[1], side[0]]) * canvas.unit
    base = pin + 1.75 * canvas.unit * side
    with canvas.on(GROUND):
        canvas.shape(np.array([pin, base + 1.05 * across, base - 1.05 * across]), order=1.6, fill=PAPER)
        canvas.hatched(base - 1.6 * across, base + 1.6 * across, side)


def _prismatic(canvas: Canvas, place: Place) -> None:
    u, axis = canvas.unit, place.axis
    normal = np.array([-axis[1], axis[0]])
    sliding = place.joint.j.body.name
    on_guide = place.i + float((place.j - place.i) @ axis) * axis
    if place.grounded:
        side = -normal if normal[1] > 0 or (normal[1] == 0 and normal[0] > 0) else normal
        a, b = (end + BLOCK[1] * u * side for end in place.range(2.4 * u))
        with canvas.on(on_body(place.joint.i.body.name)):
            canvas.hatched(a, b, side)
    else:
        a, b = place.range(2.8 * u)
        with canvas.on(on_body(place.joint.i.body.name)):
            canvas.line([a, b], place.colours[place.joint.i.body.name], 2.2, order=3.5)
    box = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)]) * np.array(BLOCK) * u
    centre = place.j if not place.pose.closed else on_guide
    outline = centre + box[:, :1] * axis + box[:, 1:] * normal
    colour = place.colours.get(sliding, QUIET)
    with canvas.on(on_body(sliding)):
        canvas.shape(outline, edge=PAPER, order=4.4)
        canvas.shape(outline, edge=colour, fill=colour, width=1.6, order=4.5, alpha=0.22)
        canvas.label(place.joint.name, centre, BLOCK[0] + 0.2)


def _slot(canvas: Canvas, place: Place) -> None:
    u = canvas.unit
    a, b = place.range(1.6 * u)
    edge = place.colours.get(place.joint.i.body.name, INK)
    with canvas.on(on_body(place.joint.i.body.name)):
        if place.joint.i.body.name == "ground":
            side = np.array([place.axis[1], -place.axis[0]])
            canvas.hatched(a + 1.1 * u * side, b + 1.1 * u * side, side)
        canvas.shape(rounded(np.array([a, b]), 0.78 * u), edge=edge, order=4.6, width=1.3, alpha=0.6)
    with canvas.on(at_place(place.joint.j)):
        canvas.circle(place.j, PIN, order=8, width=1.5)
        canvas.label(place.joint.name, place.j, PIN + 0.5)


def _weld(canvas: Canvas, place: Place) -> None:
    u = canvas.unit
    if place.grounded:
        side = place.free_side
        across = np.array([-side[1], side[0]]) * 1.6 * u
        with canvas.on(GROUND):
            canvas.hatched(place.j + 0.6 * u * side - across, place.j + 0.6 * u * side + across, side)
    square = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)]) * 0.55 * u
    with canvas.on(place.carrier):
        canvas.shape(place.j + square, fill=INK, order=8)
        _open(canvas, place)
        canvas.label(place.joint.name, place.j, 0.9)


def _distance(canvas: Canvas, place: Place) -> None:
    with canvas.on(along_line(place.joint.i, place.joint.j)):
        canvas.line([place.i, place.j], INK, 1.8, order=5)
        canvas.label(place.joint.name, (place.i + place.j) / 2, 0.4)
    _ends(canvas, place)


def _ends(canvas: Canvas, place: Place) -> None:
    """Draw the small pins of a rod or an actuator; one on ground with its support."""
    for marker, end in ((place.joint.i, place.i), (place.joint.j, place.j)):
        if marker.body.name == "ground":
            _support(canvas, end, place.free_side)
        with canvas.on(at_place(marker)):
            canvas.circle(end, 0.72 * PIN, order=8.5, width=1.2)


def _link(canvas: Canvas, place: Place) -> None:
    """Draw a kind without a symbol of its own."""
    with canvas.on(along_line(place.joint.i, place.joint.j)):
        canvas.line([place.i, place.j], INK, 1.2, order=5, dash=(4, 2))
        canvas.label(place.joint.name, (place.i + place.j) / 2, 0.5)
    for marker, end in ((place.joint.i, place.i), (place.joint.j, place.j)):
        with canvas.on(at_place(marker)):
            canvas.circle(end, 0.3, order=8, fill=INK)


def _open(canvas: Canvas, place: Place) -> None:
    """Draw a joint that does not close: a red line from marker to marker."""
    if not place.pose.closed and float(np.hypot(*(place.j - place.i))) > 0.05 * canvas.unit:
        canvas.circle(place.i, PIN, order=8, width=1.5, edge=WRONG)
        canvas.line([place.i, place.j], WRONG, 1.6, order=9, dash=(2, 1.5))


# -- drivers ----------------------------------------------------------------------------------------------------


def _drive_angle(canvas: Canvas, place: Place) -> None:
    u, centre = canvas.unit, place.j
    toward = place.pose.frames[place.joint.j.body.name][2]
    angles = toward + np.radians(np.linspace(20, 120, 25))
    arc = centre + 2.1 * u * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    with canvas.on(on_body(place.joint.j.body.name)):
        canvas.line(arc[:-2], MOVED, 1.8, order=7)
        canvas.head(arc[-1], arc[-1] - arc[-3], MOVED)
        canvas.label(place.joint.name, arc[12], 0.3, MOVED)


def _drive_coordinate(canvas: Canvas, place: Place) -> None:
    u, axis = canvas.unit, place.axis
    normal = np.array([-axis[1], axis[0]])
    normal = normal if normal[1] > 0 or (normal[1] == 0 and normal[0] > 0) else -normal
    start = place.j + 1.9 * u * normal
    with canvas.on(along_axes(place.joint.i, place.joint.j)):
        canvas.line([start - 1.4 * u * axis, start + 1.1 * u * axis], MOVED, 1.8, order=7)
        canvas.head(start + 1.6 * u * axis, axis, MOVED)
    with canvas.on(at_place(place.joint.j)):
        canvas.label(place.joint.name, start, 0.3, MOVED)


def _drive_distance(canvas: Canvas, place: Place) -> None:
    """Draw a cylinder from marker i and its rod to marker j."""
    u, gap = canvas.unit, place.j - place.i
    length = float(np.hypot(*gap))
    along = gap / length if length > 0 else place.axis
    across = np.array([-along[1], along[0]]) * 0.6 * u
    a, b = place.i + 0.12 * gap, place.i + 0.62 * gap
    with canvas.on(along_line(place.joint.i, place.joint.j)):
        canvas.line([place.i, place.j], MOVED, 2.0, order=5)
        canvas.shape(np.array([a + across, b + across, b - across, a - across]), edge=MOVED, order=5.5)
        canvas.label(place.joint.name, (a + b) / 2, 0.8, MOVED)
    _ends(canvas, place)


SYMBOLS: dict[str, Callable[[Canvas, Place], None]] = {
    "revolute": _revolute,
    "prismatic": _prismatic,
    "pin_in_slot": _slot,
    "weld": _weld,
    "distance": _distance,
    "gear_pair": lambda canvas, place: draw_gear_pair(canvas, place.joint, place.pose, place.colours),
    "belt": lambda canvas, place: draw_belt(canvas, place.joint, place.pose, place.colours),
    "cable_span": lambda canvas, place: draw_span(canvas, place.joint, place.pose, place.colours),
    "rack_and_pinion": draw_rack,
    "rolling_disc": draw_rolling_disc,
    "rolling_on_curve": draw_rolling_on_curve,
    "point_on_curve": draw_point_on_curve,
    "cam_roller": draw_cam,
    "cam_flat": draw_cam,
    "geneva": draw_geneva,
    "drive_angle": _drive_angle,
    "drive_relative_angle": _drive_angle,
    "drive_coordinate": _drive_coordinate,
    "drive_distance": _drive_distance,
}
