"""The moving skeleton of the same mechanism with other numbers, from the one before: for pages that follow a slider.

One pose is drawn instead of many. Size of the symbols and extent stay as they were.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mbsd.drawing.pose import tracks_of
from mbsd.drawing.strokes import Stroke
from mbsd.drawing.view.carried import LOOKED_AT, Carried, Moving, drawn_at, names_over
from mbsd.results.solution import Solution


def redrawn(solution: Solution, before: Moving) -> Moving | None:
    """The skeleton of ``solution``; ``before`` is that of the same mechanism with other numbers.

    None where it must be made anew: what is drawn has changed, or something is carried by nothing.
    """
    m, tracks = solution.mechanism, tracks_of(solution)
    joints = {joint.name for joint in (*m.joints.values(), *m.drivers.values())}
    if not joints <= before.steady.sides.keys() or not {body for body, _ in before.steady.wheels} <= m.bodies.keys():
        return None
    canvas = drawn_at(m, tracks, before.steady, 0)
    if [_kind(stroke) for stroke in canvas.strokes] != [_kind(earlier.stroke) for earlier in before.strokes]:
        return None
    looked = np.unique(np.linspace(0, len(solution.t) - 1, LOOKED_AT).round().astype(int))
    names = names_over(canvas, tracks, looked)
    strokes = [Carried(stroke, stroke.carrier) for stroke in canvas.strokes if stroke.carrier is not None]
    if len(strokes) < len(canvas.strokes):
        return None
    return replace(before, strokes=strokes, names=names, times=solution.t[[0, -1]])


def _kind(stroke: Stroke) -> tuple[bool, str, str | None, float, str | None]:
    return stroke.closed, stroke.ink, stroke.fill, stroke.order, None if stroke.carrier is None else stroke.carrier.kind
