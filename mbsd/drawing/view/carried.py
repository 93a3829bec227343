"""The skeleton for any moment of a motion: each stroke with what carries it, found from some poses.

ground    it stays where it is
body      it moves with a body's frame
place     it moves with a point of a body, and does not turn
line      it moves with the line from one point of a body to one of another: it is stretched along it, not across
shapes    nothing of these: it is recorded in many poses, and what is between two is a mean of both

Where several hold, the first one is taken. Outlines are compared as curves, because their corners may be others.
"""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from mbsd.drawing.canvas import Label
from mbsd.drawing.pose import Tracks, tracks_of
from mbsd.drawing.skeleton import draw_on
from mbsd.drawing.steady import Steady, steady_of
from mbsd.drawing.strokes import Recorder, Stroke
from mbsd.drawing.view.carriers import GROUND, Carrier, Frames, candidates
from mbsd.drawing.view.curves import alike, resampled
from mbsd.results.solution import Solution

LOOKED_AT = 9
"""Poses that must agree."""
SHAPES = 60
"""Poses in which a stroke is recorded that nothing carries, in equal times, and the end of the motion."""
SLACK = 0.02
"""How far two curves may be apart that count as one, in units of the symbols."""
TEETH = 0.15
"""The same of outlines of a body's own colour: teeth are sampled elsewhere in every pose."""


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
    """Those that nothing carries are left out."""
    times: np.ndarray
    """(k,) of the shapes (s)."""
    steady: Steady


def moving(solution: Solution) -> Moving:
    """The skeleton of a solution."""
    m, tracks = solution.mechanism, tracks_of(solution)
    steps = _steps(solution.t, SHAPES)
    places = np.unique(np.linspace(0, len(steps) - 1, LOOKED_AT).round().astype(int))
    looked = [int(step) for step in steps[places]]
    colours = {name: f"body:{name}" for name in m.bodies if name != "ground"}
    steady = steady_of(m, [tracks.pose(step) for step in looked], colours, Recorder)
    drawn = {step: _drawn(solution, tracks, steady, colours, step) for step in looked}
    first, frames = drawn[looked[0]], {step: Frames(tracks, step) for step in looked}
    known = candidates(m)

    def holds(candidate: Carrier, series: Sequence[np.ndarray | None], closed: bool, slack: float) -> bool:
        pairs = reversed(list(zip(looked, series, strict=True)))
        return all(
            points is not None
            and alike(candidate.moved(series[0], frames[looked[0]], frames[step]), points, closed, slack)
            for step, points in pairs
        )

    def carrier(series: Sequence[np.ndarray | None], closed: bool, ink: str) -> Carrier | None:
        named = [
            candidate for candidate in known if candidate.kind == "body" and f"body:{candidate.ends[0].body}" == ink
        ]
        strict = [(candidate, SLACK) for candidate in (GROUND, *named, *known)]
        tried = [*strict, *((candidate, TEETH) for candidate in named if closed)]
        return next(
            (candidate for candidate, slack in tried if holds(candidate, series, closed, slack * steady.unit)), None
        )

    series = {step: _aligned(first.strokes, canvas.strokes) for step, canvas in drawn.items()}
    carriers = [
        carrier([series[step][k] for step in looked], stroke.closed, stroke.ink)
        for k, stroke in enumerate(first.strokes)
    ]
    free = [k for k, by in enumerate(carriers) if by is None]
    shapes: dict[int, list[np.ndarray]] = {k: [] for k in free}
    if free:
        for step in steps:
            canvas = drawn.get(int(step)) or _drawn(solution, tracks, steady, colours, int(step))
            here = _aligned(first.strokes, canvas.strokes)
            for k in free:
                points = here[k]
                shapes[k].append(np.zeros((0, 2)) if points is None else points)
    strokes = [
        Carried(stroke, by)
        if by is not None
        else Carried(stroke, Carrier("shapes"), resampled(shapes[k], stroke.closed))
        for k, (stroke, by) in enumerate(zip(first.strokes, carriers, strict=True))
    ]
    names = []
    for k, label in enumerate(first.labels):
        places = [
            canvas.labels[k].anchor.reshape(1, 2)
            if len(canvas.labels) > k and canvas.labels[k].text == label.text
            else None
            for canvas in drawn.values()
        ]
        by = carrier(places, False, label.colour)
        if by is not None:
            names.append((label, by))
    return Moving(strokes, names, solution.t[steps], steady)


def _steps(t: np.ndarray, count: int) -> np.ndarray:
    """Outputs nearest to equal times, the first and the last with them."""
    times = np.linspace(t[0], t[-1], count + 1)
    return np.unique(np.abs(t[:, None] - times).argmin(axis=0))


def _drawn(solution: Solution, tracks: Tracks, steady: Steady, colours: dict[str, str], step: int) -> Recorder:
    canvas = Recorder(None, steady.unit)
    turned = {name: float(view.theta[step] - view.theta[0]) for name, view in tracks.views.items()}
    steady.ready(canvas, turned)
    draw_on(canvas, solution.mechanism, tracks.pose(step), colours, False, steady.sides)
    return canvas


def _aligned(first: list[Stroke], other: list[Stroke]) -> list[np.ndarray | None]:
    """The points of each stroke of ``first`` in another pose; None where it is not drawn there."""
    if len(first) == len(other):
        return [stroke.points for stroke in other]
    a, b = ([(s.closed, s.ink, s.fill, s.width, s.order) for s in strokes] for strokes in (first, other))
    out: list[np.ndarray | None] = [None] * len(first)
    for block in difflib.SequenceMatcher(None, a, b, autojunk=False).get_matching_blocks():
        for k in range(block.size):
            out[block.a + k] = other[block.b + k].points
    return out
