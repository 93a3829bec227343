"""Sign of a Geneva: the crank with its pin and locking disc, the wheel with its slots and locking arcs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mbsd.drawing.canvas import Canvas
from mbsd.drawing.carriers import on_body
from mbsd.drawing.look import PAPER, QUIET
from mbsd.drawing.symbols.reach import geneva_radius

if TYPE_CHECKING:
    from mbsd.drawing.symbols.place import Place

LOCK = 0.8
"""Radius of the locking disc, of that of the pin's circle."""
PIN, WIDE = 0.5, 0.6
"""Radius of the pin and half width of a slot, in units, if the wheel has room for them."""


def draw_geneva(canvas: Canvas, place: Place) -> None:
    """The crank is drawn over the wheel."""
    joint, u = place.joint, canvas.unit
    slots, radius = joint.params["slots"], joint.params["radius"]
    distance = float(np.hypot(*(place.j - place.i)))
    rim = geneva_radius(joint, place.pose)
    wide = min(WIDE * u, 0.25 * rim * math.sin(math.pi / slots))
    turned = place.pose.axis(joint.j)
    wheel = place.colours.get(joint.j.body.name, QUIET)
    outline = _wheel(slots, distance, radius, rim, wide)
    with canvas.on(on_body(joint.j.body.name)):
        canvas.shape(_placed(place.j, turned, outline), edge=wheel, fill=wheel, width=1.4, order=1.8, alpha=0.14)
    crank = place.colours.get(joint.i.body.name, QUIET)
    lock = _placed(place.i, place.axis, _lock(slots, distance - rim, LOCK * radius))
    pin = place.i + radius * place.axis
    with canvas.on(on_body(joint.i.body.name)):
        canvas.shape(lock, edge=crank, fill=crank, width=1.2, order=1.9, alpha=0.14)
        canvas.line([place.i, pin], crank, 3.0, order=3)
        canvas.circle(pin, wide / u * PIN / WIDE, edge=crank, fill=PAPER, width=1.4, order=8)
        canvas.label(joint.name, pin, 0.7)


def _placed(centre: np.ndarray, axis: np.ndarray, points: np.ndarray) -> np.ndarray:
    return centre + points @ np.array([axis, [-axis[1], axis[0]]])


def _wheel(slots: int, distance: float, radius: float, rim: float, wide: float) -> np.ndarray:
    """(k, 2) outline with a slot along the x axis and locking arcs between the slots."""
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
    """(k, 2) outline of the locking disc, cut away towards the pin (the x axis) for the wheel's tips."""
    half = math.pi / 2 - math.pi / slots
    arc = np.linspace(half, 2 * math.pi - half, 61)
    rim = lock * np.stack([np.cos(arc), np.sin(arc)], axis=1)
    s = np.linspace(-1.0, 1.0, 21)[:, None]
    deep = 0.8 * min(room, 0.8 * lock * math.cos(half))
    ends = lock * np.array([math.cos(half), math.sin(half)])
    cut = np.hstack([deep + (ends[0] - deep) * s**2, ends[1] * s])
    return np.vstack([rim, cut[1:-1]])
