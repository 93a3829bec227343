"""The skeleton at any moment: strokes of its first pose, each with its carrier (carriers.py).

A stroke without a carrier is drawn in many poses. Pages that follow a slider redraw the first pose alone, with other
numbers; extent and size of the symbols stay as they were.
"""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from mbsd.drawing.canvas import TOGETHER, Label
from mbsd.drawing.carriers import Carrier, Frames
from mbsd.drawing.pose import Tracks, tracks_of
from mbsd.drawing.skeleton import Steady, draw_on, steady_of
from mbsd.drawing.strokes import Recorder, Stroke
from mbsd.model.mechanism import Model
from mbsd.results.solution import Solution

LOOKED_AT = 9
"""Poses from which extent, size of symbols and turns of springs are taken."""
SHAPES = 60
"""Poses in which a stroke is recorded that nothing carries, in equal times, and the end of the motion."""


@dataclass(frozen=True)
class Carried:
    """A stroke in the first pose, and what carries it."""

    stroke: Stroke
    carrier: Carrier
    shapes: list[np.ndarray] = field(default_factory=list)
    """(k, 2) points (m) at the times of the shapes, of one number; none where it has a carrier."""


@dataclass(frozen=True)
class Moving:
    """The whole skeleton: world axes, m, in the first pose."""

    strokes: list[Carried]
    names: list[tuple[Label, Carrier]]
    """Labels with their carriers; labels that nothing carries are left out."""
    times: np.ndarray
    """(k,) of the shapes (s)."""
    steady: Steady


def moving(solution: Solution) -> Moving:
    """Return the skeleton of a solution."""
    m, tracks = solution.mechanism, tracks_of(solution)
    steps = equal_steps(solution.t, SHAPES)
    places = np.unique(np.linspace(0, len(steps) - 1, LOOKED_AT).round().astype(int))
    steady = steady_of(m, [tracks.pose(int(step)) for step in steps[places]], _colours(m), Recorder)
    first = drawn_at(m, tracks, steady, int(steps[0]))
    free = [stroke for stroke in first.strokes if stroke.carrier is None]
    shapes = iter(_shapes(m, tracks, steady, steps, free))
    strokes = [
        Carried(stroke, stroke.carrier)
        if stroke.carrier is not None
        else Carried(stroke, Carrier("shapes"), next(shapes))
        for stroke in first.strokes
    ]
    return Moving(strokes, names_over(first, tracks, steps[places]), solution.t[steps], steady)


def drawn_at(m: Model, tracks: Tracks, steady: Steady, step: int) -> Recorder:
    """Return the skeleton at one output."""
    canvas = Recorder(None, steady.unit)
    steady.ready(canvas, {name: float(view.theta[step] - view.theta[0]) for name, view in tracks.views.items()})
    draw_on(canvas, m, tracks.pose(step), _colours(m), False, steady.sides)
    return canvas


def names_over(first: Recorder, tracks: Tracks, steps: np.ndarray) -> list[tuple[Label, Carrier]]:
    """Return names with their carriers, from where they are at the first of ``steps``.

    Names that share a place at all of these steps are one.
    """
    frames = [Frames(tracks, int(step)) for step in steps]
    out: list[tuple[Label, Carrier, np.ndarray]] = []
    for label in first.names:
        if label.carrier is None:
            continue
        anchor = label.anchor.reshape(1, 2)
        places = np.concatenate([label.carrier.moved(anchor, frames[0], now) for now in frames])
        for k, (other, carrier, there) in enumerate(out):
            apart = float(np.hypot(*(places - there).T).max())
            if other.colour == label.colour and apart < TOGETHER * first.unit:
                out[k] = replace(other, text=f"{other.text}, {label.text}"), carrier, there
                break
        else:
            out.append((label, label.carrier, places))
    return [(label, carrier) for label, carrier, _ in out]


def _colours(m: Model) -> dict[str, str]:
    return {name: f"body:{name}" for name in m.bodies if name != "ground"}


def equal_steps(t: np.ndarray, count: int) -> np.ndarray:
    """Return the outputs nearest to equal times, the first and the last with them."""
    times = np.linspace(t[0], t[-1], count + 1)
    return np.unique(np.abs(t[:, None] - times).argmin(axis=0))


def _shapes(m: Model, tracks: Tracks, steady: Steady, steps: np.ndarray, free: list[Stroke]) -> list[list[np.ndarray]]:
    """Return points of strokes that nothing carries, at all steps."""
    shapes: list[list[np.ndarray]] = [[] for _ in free]
    for step in steps if free else ():
        here = [stroke for stroke in drawn_at(m, tracks, steady, int(step)).strokes if stroke.carrier is None]
        for shape, points in zip(shapes, _aligned(free, here), strict=True):
            shape.append(np.zeros((0, 2)) if points is None else points)
    return [resampled(shape, stroke.closed) for shape, stroke in zip(shapes, free, strict=True)]


def _aligned(first: Sequence[Stroke], other: Sequence[Stroke]) -> list[np.ndarray | None]:
    """Return the points of each stroke of ``first`` in another pose; None where it is not drawn there."""
    if len(first) == len(other):
        return [stroke.points for stroke in other]
    a, b = ([(s.closed, s.ink, s.fill, s.width, s.order) for s in strokes] for strokes in (first, other))
    out: list[np.ndarray | None] = [None] * len(first)
    for block in difflib.SequenceMatcher(None, a, b, autojunk=False).get_matching_blocks():
        for k in range(block.size):
            out[block.a + k] = other[block.b + k].points
    return out


def resampled(shapes: Sequence[np.ndarray], closed: bool) -> list[np.ndarray]:
    """Return polylines (k, 2) with one number of corners, unchanged if they have that already.

    What is not drawn, (0, 2), becomes the one place where it was before, or will be.
    """
    counts = {len(shape) for shape in shapes if len(shape)}
    if len(counts) == 1 and all(len(shape) for shape in shapes):
        return list(shapes)
    most = max(counts, default=1)
    out: list[np.ndarray] = []
    last = next((shape[0] for shape in shapes if len(shape)), np.zeros(2))
    for shape in shapes:
        out.append(_sampled(shape, most, closed) if len(shape) else np.tile(last, (most, 1)))
        last = out[-1][0]
    return out


def _sampled(shape: np.ndarray, count: int, closed: bool) -> np.ndarray:
    """Return ``count`` places evenly along a polyline; an outline begins at its rightmost corner."""
    if closed:
        first = int(shape[:, 0].argmax())
        shape = np.vstack([shape[first:], shape[: first + 1]])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(shape, axis=0).T))])
    along = np.linspace(0.0, way[-1], count + 1)[:-1] if closed else np.linspace(0.0, way[-1], count)
    return np.stack([np.interp(along, way, shape[:, k]) for k in range(2)], axis=1)


def redrawn(solution: Solution, before: Moving) -> Moving | None:
    """Return the skeleton of ``solution``; ``before`` is that of the same mechanism with other numbers.

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
