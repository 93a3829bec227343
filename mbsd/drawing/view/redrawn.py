"""The moving skeleton of the same mechanism with other numbers, from the one before: for pages that follow a slider.

What carries a stroke is the same joint or body as before, so one pose is drawn instead of many. Size of the symbols
and extent stay as they were.
"""

from __future__ import annotations

from dataclasses import replace

from mbsd.drawing.pose import tracks_of
from mbsd.drawing.skeleton import draw_on
from mbsd.drawing.strokes import Recorder, Stroke
from mbsd.drawing.view.carried import Carried, Moving
from mbsd.drawing.view.carriers import GROUND, Carrier, candidates
from mbsd.model.mechanism import Model
from mbsd.results.solution import Solution


def redrawn(solution: Solution, before: Moving, old: Model) -> Moving | None:
    """The skeleton of ``solution``; ``before`` is that of the model ``old``.

    None where it must be made anew: what is drawn has changed, or something is carried by nothing.
    """
    m = solution.mechanism
    was, now = candidates(old), candidates(m)
    if len(was) != len(now) or any(earlier.carrier.kind == "shapes" for earlier in before.strokes):
        return None
    same = dict(zip(was, now, strict=True)) | {GROUND: GROUND}
    if any(carrier.kind != other.kind or _bodies(carrier) != _bodies(other) for carrier, other in same.items()):
        return None
    tracks = tracks_of(solution)
    colours = {name: f"body:{name}" for name in m.bodies if name != "ground"}
    canvas = Recorder(None, before.steady.unit)
    before.steady.ready(canvas, dict.fromkeys(tracks.views, 0.0))
    draw_on(canvas, m, tracks.pose(0), colours, False, before.steady.sides)
    if [_kind(stroke) for stroke in canvas.strokes] != [_kind(earlier.stroke) for earlier in before.strokes]:
        return None
    labels = {(label.text, label.colour): label for label in canvas.labels}
    if any((label.text, label.colour) not in labels for label, _ in before.names):
        return None
    strokes = [
        Carried(stroke, same[earlier.carrier]) for stroke, earlier in zip(canvas.strokes, before.strokes, strict=True)
    ]
    names = [(labels[label.text, label.colour], same[by]) for label, by in before.names]
    return replace(before, strokes=strokes, names=names, times=solution.t[[0, -1]])


def _bodies(carrier: Carrier) -> list[str]:
    return [end.body for end in carrier.ends]


def _kind(stroke: Stroke) -> tuple[bool, str, str | None, float]:
    return stroke.closed, stroke.ink, stroke.fill, stroke.order
