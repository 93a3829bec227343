"""The skeleton as plain polylines with the same symbols, for programs without matplotlib."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from mbsd.drawing.canvas import Canvas, Label, Point
from mbsd.drawing.carriers import Carrier
from mbsd.drawing.look import AXIS_X, AXIS_Y, FAINT, INK, LOAD, MOVED, PAPER, QUIET, WRONG
from mbsd.drawing.pose import pose_of
from mbsd.drawing.skeleton import draw_on, measure

if TYPE_CHECKING:
    from mbsd.results.solution import Solution

ROLES = {
    INK: "ink",
    QUIET: "quiet",
    PAPER: "paper",
    FAINT: "faint",
    MOVED: "driver",
    LOAD: "load",
    WRONG: "wrong",
    AXIS_X: "x",
    AXIS_Y: "y",
}
"""Meaning of the colours of the drawing; those of bodies are ``body:`` and the name."""


@dataclass(frozen=True)
class Stroke:
    """One polyline or closed outline."""

    points: np.ndarray
    """(k, 2) m, world."""
    closed: bool
    ink: str
    """Role of the line's colour (:data:`ROLES`, or ``body:crank``)."""
    fill: str | None
    """Role of the filling's colour; None: not filled."""
    alpha: float
    """Opacity of the filling, or of an open line."""
    width: float
    """Points."""
    order: float
    """Higher ones are drawn over lower ones."""
    dash: tuple[float, ...]
    """Lengths of strokes and gaps in line widths; empty: solid."""
    sign: str | None = None
    """``"centre of mass"``, of its mark."""
    carrier: Carrier | None = None
    """Carrier of it through a motion; None if nothing carries it."""


@dataclass(frozen=True)
class Strokes:
    """The mechanism in one pose."""

    time: float
    strokes: list[Stroke]
    labels: list[Label]
    """Names with the place they belong to; their colours are roles."""
    unit: float
    """Size of the symbols (m): about the radius of a pin's outer circle."""


@dataclass(eq=False)
class Recorder(Canvas):
    """A canvas that keeps what is drawn."""

    strokes: list[Stroke] = field(default_factory=list)
    names: list[Label] = field(default_factory=list)
    """Each by itself, where ``labels`` has those that share a place as one."""

    def band(self, outer: Point, inner: Point, colour: str) -> None:
        """Keep the area between two outlines (m) as one outline with a seam, and both edges."""
        seam = np.vstack([outer, outer[:1], inner[::-1], inner[-1:]])
        self._draw(seam, True, colour, colour, 0.12, 0.0, 1.69)
        for outline in (outer, inner):
            self._draw(np.asarray(outline, float), True, colour, None, 1.0, 1.3, 1.7)

    def label(self, text: str, anchor: Point, clearance: float, colour: str = INK, size: float = 10.0) -> None:
        """Ask for a name; its colour is kept as a role."""
        self.names.append(Label(text, anchor, clearance, _role(colour), size, self.carrier))
        super().label(text, anchor, clearance, _role(colour), size)

    def _draw(
        self,
        path: Point,
        closed: bool,
        ink: str,
        fill: str | None,
        alpha: float,
        width: float,
        order: float,
        dash: Sequence[float] = (),
    ) -> None:
        role = None if fill is None else _role(fill)
        dashes = tuple(map(float, dash))
        self.strokes.append(
            Stroke(path, closed, _role(ink), role, alpha, width, order, dashes, self.sign, self.carrier)
        )


def strokes_of(solution: Solution, steps: Sequence[int]) -> list[Strokes]:
    """Return the skeleton at output ``steps``, in symbols of one size."""
    m = solution.mechanism
    colours = {name: f"body:{name}" for name in m.bodies if name != "ground"}
    poses = [pose_of(solution, None, int(step)) for step in steps]
    unit = min((measure(m, pose)[2] for pose in poses), default=1.0)
    out = []
    for step, pose in zip(steps, poses, strict=True):
        canvas = Recorder(None, unit)
        draw_on(canvas, m, pose, colours, frames=False)
        out.append(Strokes(float(solution.t[step]), canvas.strokes, canvas.labels, unit))
    return out


def moved(first: Strokes, other: Strokes) -> list[Stroke]:
    """Return the strokes of ``other`` that are elsewhere than in ``first``."""
    slack = 1e-6 * first.unit
    pairs = itertools.zip_longest(first.strokes, other.strokes)
    return [b for a, b in pairs if b is not None and (a is None or _differ(a.points, b.points, slack))]


def _differ(a: np.ndarray, b: np.ndarray, slack: float) -> bool:
    return a.shape != b.shape or bool(np.abs(a - b).max(initial=0.0) > slack)


def _role(colour: str) -> str:
    return ROLES.get(colour, colour)
