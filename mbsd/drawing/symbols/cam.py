"""Signs of cams: the disc as it is cut, its base circle, and the follower's roller or face."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mbsd.drawing.canvas import Canvas
from mbsd.drawing.carriers import at_place, on_body
from mbsd.drawing.look import PAPER, QUIET
from mbsd.drawing.symbols.reach import placed, profile_of

if TYPE_CHECKING:
    from mbsd.drawing.symbols.place import Place

POINTS = 240
"""Number of points of the outline at most."""


def draw_cam(canvas: Canvas, place: Place) -> None:
    """The disc at marker i, and a roller about marker j or a face along its x axis."""
    joint = place.joint
    profile = profile_of(joint.params)
    outline = profile.outline[:: max(1, len(profile.outline) // POINTS)]
    colour = place.colours.get(joint.i.body.name, QUIET)
    turn = np.linspace(0.0, 2 * math.pi, 73)
    circle = profile.sizes["base_radius"] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    with canvas.on(on_body(joint.i.body.name)):
        canvas.shape(placed(place.pose, joint.i, outline), edge=colour, fill=colour, width=1.5, order=1.8, alpha=0.14)
        canvas.line(place.i + circle, colour, 0.7, order=1.9, linestyle=(0, (8, 2, 2, 2)))
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
