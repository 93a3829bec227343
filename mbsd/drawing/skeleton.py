"""The skeleton: links, joints by standard symbols, frames, centres of mass, traced points.

Pictures of one motion share a :class:`Steady`: extent, size of the symbols, sides of ground's signs, turns of springs.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.arguments import switch
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.drawing.canvas import Canvas, place_names
from mbsd.drawing.carriers import GROUND, at_place, on_body
from mbsd.drawing.look import AXIS_X, AXIS_Y, FAINT, INK, QUIET, body_inks, literal
from mbsd.drawing.pose import Pose
from mbsd.drawing.symbols.contacts import contact_reach, draw_contacts
from mbsd.drawing.symbols.geometry import Place, free_side, reach, rounded
from mbsd.drawing.symbols.joints import draw_joint
from mbsd.drawing.symbols.loads import draw_force, force_reach
from mbsd.drawing.symbols.wheels import rim_of, ring_gear
from mbsd.model.body import Marker
from mbsd.model.cables import seen_span
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model, hidden_bodies
from mbsd.model.outlines.outline import Outline
from mbsd.pictures import Picture

if TYPE_CHECKING:
    from matplotlib.axes import Axes


WIDTH, TALLEST, FLATTEST = 7.0, 7.0, 2.6
"""Width, largest and least height of a figure of our own (inches)."""
UNITS_ACROSS = 34.0
"""Units in the larger side of a drawing."""
SMALLEST = 1e-12
"""A unit (m) below this is the rounding of one single place."""


@literal
def draw(m: Model, pose: Pose, ax: Axes | None, frames: bool, names: bool) -> Picture:
    """Draw ``m`` in ``pose`` into ``ax``, or into a figure of its own."""
    try:
        import matplotlib.axes
    except ImportError as error:
        raise ModelError("drawing needs matplotlib: install mbsd[draw]") from error
    if ax is not None and not isinstance(ax, matplotlib.axes.Axes):
        raise ModelError(f"{m.name}: ax is {shown(ax)}; give axes of matplotlib, or leave it out")
    for what, value in (("frames", frames), ("names", names)):
        switch(f"{m.name}: draw: {what}", value)
    low, high, unit = measure(m, pose)
    low, high = low - 3.4 * unit, high + 3.4 * unit
    own = ax is None
    if ax is None:
        ax = _axes(high - low)
    canvas = Canvas(ax, unit)
    colours = body_inks(m)
    for path in pose.paths.values():
        canvas.line(path, QUIET, 1.2, order=1, alpha=0.8)
    draw_on(canvas, m, pose, colours, frames)
    _finish(ax, low, high, m.name, pose)
    picture = Picture(ax, own)
    if own:  # the layout is settled once, so that names stand right and every format is the same picture
        picture.figure.draw_without_rendering()
        picture.figure.set_layout_engine("none")
    if names:
        place_names(canvas)
    return picture


def _without_hidden(m: Model) -> Model:
    """Return the model without its hidden bodies and their joints; itself if it has none."""
    hidden = hidden_bodies(m)
    if not hidden:
        return m
    out = copy.copy(m)
    out.bodies = {name: body for name, body in m.bodies.items() if name not in hidden}
    out.joints = {
        name: seen_span(m, joint) if "span" in joint.kind.constraints else joint
        for name, joint in m.joints.items()
        if "span" in joint.kind.constraints or not hidden.intersection(joint.bodies)
    }
    out.forces = {name: force for name, force in m.forces.items() if not hidden.intersection(force.bodies)}
    return out


def measure(m: Model, pose: Pose) -> tuple[np.ndarray, np.ndarray, float]:
    """Return lowest and highest x, y (m) of all that is drawn, and the unit of the symbols (m)."""
    m = _without_hidden(m)
    points = {name: _points(m, pose, name) for name in m.bodies}
    wide = [reach(joint, pose) for joint in m.joints.values() if not pose.gone(joint.name)]
    loads = [force_reach(force, pose, list(m.joints.values())) for force in m.forces.values()]
    loads += [contact_reach(joint, pose) for joint in m.contacts.values()]
    outlines = [_outline_path(pose, outline) for outline in m.outlines.values()]
    everything = np.concatenate([*points.values(), *pose.paths.values(), *wide, *loads, *outlines])
    if not len(everything):
        everything = np.zeros((1, 2))
    low, high = everything.min(axis=0), everything.max(axis=0)
    return low, high, _unit(high - low, points)


def measure_all(m: Model, poses: Sequence[Pose]) -> tuple[np.ndarray, np.ndarray, float]:
    """Return the same over several poses, in symbols of one size."""
    m = _without_hidden(m)
    lows, highs, _ = zip(*(measure(m, pose) for pose in poses), strict=True)
    low, high = np.min(lows, axis=0), np.max(highs, axis=0)
    lengths = [{name: _points(m, pose, name) for name in m.bodies} for pose in poses]
    return low, high, min(_unit(high - low, points) for points in lengths)


def draw_on(
    canvas: Canvas,
    m: Model,
    pose: Pose,
    colours: dict[str, str],
    frames: bool,
    sides: Mapping[str, np.ndarray] | None = None,
) -> None:
    """Draw bodies, joints, drivers, forces, contacts and traced points, and ask for their names.

    ``colours``: by body. ``sides``: where ground's signs go, by joint; by default where there is room in this pose.
    """
    m = _without_hidden(m)
    colours = {name: colour for name, colour in colours.items() if name in m.bodies}
    points, unit = {name: _points(m, pose, name) for name in m.bodies}, canvas.unit
    for name in colours:
        with canvas.on(on_body(name)):
            _link(canvas, m, pose, name, points[name], colours[name], frames)
    for outline in m.outlines.values():
        name = outline.body.name
        with canvas.on(on_body(name)):
            path, ink = _outline_path(pose, outline), colours.get(name, QUIET)
            if outline.is_hole:
                canvas.line(path, ink, 1.5, order=2)
            else:
                canvas.shape(path, edge=ink, fill=ink, width=1.5, order=2, alpha=0.16)
    if frames:
        with canvas.on(GROUND):
            _frame(canvas, pose, "ground", 2.6)
    for joint in (*m.joints.values(), *m.drivers.values()):
        side = free_side(_directions(m, pose, points, joint, unit)) if sides is None else sides[joint.name]
        if pose.gone(joint.name):
            canvas.leave_out(joint.name, pose.place(joint.j), joint.kind.driven)
            continue
        with canvas.uncarried(joint.name in pose.released):
            draw_joint(canvas, Place(joint, pose, colours, side))
    for force in m.forces.values():
        draw_force(canvas, force, pose, list(m.joints.values()))
    draw_contacts(canvas, list(m.contacts.values()), pose, colours)
    for name, marker in m.traces.items():
        with canvas.on(at_place(marker)):
            canvas.circle(pose.place(marker), 0.3, fill=colours.get(marker.body.name, INK), order=9, width=0.8)
            canvas.label(name, pose.place(marker), 0.5, colours.get(marker.body.name, INK))
    for name in colours:
        ring = ring_gear(m, name)
        with canvas.on(on_body(name) if ring is None else at_place(ring.i)):
            place, clearance = (_middle(points[name]), 1.1) if ring is None else (rim_of(ring, pose, unit), 0.4)
            canvas.label(name, place, clearance, colours[name], 9.5)


def _outline_path(pose: Pose, outline: Outline) -> np.ndarray:
    """Return (k, 2) points of an outline in the world (m)."""
    origin = pose.point(outline.body.name, 0.0, 0.0)
    axes = np.array([pose.point(outline.body.name, *tip) - origin for tip in ((1.0, 0.0), (0.0, 1.0))])
    return origin + outline.path() @ axes


def steady_sides(m: Model, poses: Sequence[Pose], unit: float) -> dict[str, np.ndarray]:
    """Return, by joint, the unit direction of ground's sign that has room in all of these poses."""
    m = _without_hidden(m)
    leaving: dict[str, list[float]] = {}
    for pose in poses:
        points = {name: _points(m, pose, name) for name in m.bodies}
        for joint in (*m.joints.values(), *m.drivers.values()):
            leaving.setdefault(joint.name, []).extend(_directions(m, pose, points, joint, unit))
    return {name: free_side(directions) for name, directions in leaving.items()}


def _directions(m: Model, pose: Pose, points: dict[str, np.ndarray], joint: Joint, unit: float) -> list[float]:
    """Return angles (rad) at which links leave the place of ground's sign; of a rod, its own."""
    if "distance" in joint.kind.constraints and "ground" in joint.bodies:
        gap = pose.place(joint.j) - pose.place(joint.i)
        along = gap if joint.i.body.name == "ground" else -gap
        return [math.atan2(along[1], along[0])]
    return _leaving(m, pose, points, joint.j, unit)


def _points(m: Model, pose: Pose, name: str) -> np.ndarray:
    """Return (k, 2) of all that a body carries: joints, traced points, places where others slide on it."""
    out: list[np.ndarray] = []
    for joint in (*m.joints.values(), *m.drivers.values()):
        if joint.kind.driven and joint.kind.angular:
            continue
        slides = joint.kind.slides
        if joint.j.body.name == name:
            out.append(pose.place(joint.j))
        if joint.i.body.name == name:
            start, axis = pose.place(joint.i), pose.axis(joint.i)
            reached = pose.place(joint.j) - start
            out += [start + float(reached @ axis) * axis] if slides and not pose.gone(joint.name) else []
            out += [] if slides and name == "ground" else [start]
            if slides and joint.name in pose.travel:
                out += [start + s * axis for s in (pose.travel[joint.name].min(), pose.travel[joint.name].max())]
    for force in m.forces.values():
        out += [pose.place(marker) for marker in force.kind.places(force) if marker.body.name == name]
    touching = [contact.j for contact in m.contacts.values() if not contact.params.get("radius")]
    out += [pose.place(marker) for marker in touching if marker.body.name == name]
    out += [pose.place(marker) for marker in m.traces.values() if marker.body.name == name]
    length = m.bodies[name].length
    if length is not None:
        out += [pose.point(name, 0.0, 0.0), pose.point(name, length, 0.0)]
    jointed = any(name in joint.bodies for joint in m.joints.values())
    if name != "ground" and (not out or not jointed or _alone(out)):
        out.append(pose.point(name, *m.bodies[name].com))
    return np.array(out).reshape(-1, 2)


def _alone(points: list[np.ndarray]) -> bool:
    """True if all points are one place: then a line joins it to the body's centre of mass."""
    return float(np.ptp(points, axis=0).max()) == 0.0


def _unit(size: np.ndarray, points: dict[str, np.ndarray]) -> float:
    """Return a 34th of the drawing, less where the links are shorter than four of them."""
    largest = float(size.max())
    lengths = [float(np.hypot(*np.ptp(p, axis=0))) for name, p in points.items() if len(p) > 1 and name != "ground"]
    lengths = [length for length in lengths if length > 1e-3 * largest]
    unit = largest / UNITS_ACROSS
    if lengths:
        unit = min(unit, 0.2 * float(np.median(lengths)))
    return unit if unit > SMALLEST else 1.0 / UNITS_ACROSS


def _link(canvas: Canvas, m: Model, pose: Pose, name: str, points: np.ndarray, edge: str, frames: bool) -> None:
    """Draw a body: a rounded outline around what it carries, its centre of mass and its frame."""
    body = m.bodies[name]
    sliding = any(j.kind.pair == "guide" and j.j.body is body for j in m.joints.values())
    extent = float(np.hypot(*np.ptp(points, axis=0)))
    if extent > 0.5 * canvas.unit or not sliding:
        canvas.shape(rounded(points, 0.95 * canvas.unit), edge=edge, fill=edge, width=1.5, order=2, alpha=0.16)
    if body.mass > 0:
        with canvas.on(at_place(body.at(*body.com))):
            _centre_of_mass(canvas, pose.point(name, *body.com))
    if frames:
        _frame(canvas, pose, name, 1.9)


def _centre_of_mass(canvas: Canvas, centre: np.ndarray) -> None:
    """Draw the quartered circle."""
    canvas.sign = "centre of mass"
    canvas.circle(centre, 0.42, order=5, width=0.9)
    for first in (0.0, math.pi):
        turn = np.linspace(first, first + math.pi / 2, 9)
        rim = centre + 0.42 * canvas.unit * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        canvas.shape(np.vstack([centre, rim]), fill=INK, order=5.1, width=0.0)
    canvas.sign = None


def _frame(canvas: Canvas, pose: Pose, name: str, length: float) -> None:
    """Draw a body's axes: x red, y green."""
    origin = pose.point(name, 0.0, 0.0)
    for tip, ink in (((1.0, 0.0), AXIS_X), ((0.0, 1.0), AXIS_Y)):
        end = origin + length * canvas.unit * (pose.point(name, *tip) - origin)
        canvas.line([origin, end], ink, 1.3, order=6)


def _leaving(m: Model, pose: Pose, points: dict[str, np.ndarray], j: Marker, unit: float) -> list[float]:
    """Return directions (rad) of the links that leave the pin, those of other joints there included."""
    pin = pose.place(j)
    here = [joint for joint in m.joints.values() if np.hypot(*(pose.place(joint.j) - pin)) < 0.2 * unit]
    moving = {name: None for joint in here for name in joint.bodies if name != "ground"}
    away = [p - pin for name in moving for p in points[name] if np.hypot(*(p - pin)) > 0.2 * unit]
    return [math.atan2(y, x) for x, y in away]


def _middle(points: np.ndarray) -> np.ndarray:
    return (points.min(axis=0) + points.max(axis=0)) / 2 if len(points) < 3 else points.mean(axis=0)


def _axes(size: np.ndarray) -> Axes:
    """Return axes of a new figure, shaped like the drawing; it does not belong to pyplot."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height = min(max(WIDTH * float(size[1] / size[0]), FLATTEST), TALLEST)
    width = min(max(height * float(size[0] / size[1]), 0.6 * WIDTH), WIDTH)
    figure = Figure(figsize=(width + 0.8, height + 0.8), layout="constrained")
    FigureCanvasAgg(figure)
    return figure.subplots()


def _finish(ax: Axes, low: np.ndarray, high: np.ndarray, name: str, pose: Pose) -> None:
    """Set equal, quiet axes in metres, and the title."""
    ax.set_aspect("equal", adjustable="box")
    ax.set_xlim(low[0], high[0])
    ax.set_ylim(low[1], high[1])
    ax.set_axisbelow(True)
    ax.grid(color=FAINT, linewidth=0.7)
    for spine in ax.spines.values():
        spine.set_visible(False)
    ax.tick_params(colors=QUIET, labelsize=8, length=0)
    ax.set_xlabel("x / m", color=QUIET, fontsize=8.5)
    ax.set_ylabel("y / m", color=QUIET, fontsize=8.5)
    title = name.replace("_", " ") + (f",  {pose.title}" if pose.title else "")
    ax.set_title(title, loc="left", color=INK, fontsize=11)


@dataclass(frozen=True, eq=False)
class Steady:
    """Found from some poses of a motion, the first one first."""

    low: np.ndarray
    high: np.ndarray
    """(2,) extent of the machine over the whole motion (m)."""
    unit: float
    """Unit of its symbols (m)."""
    sides: dict[str, np.ndarray]
    coils: dict[str, int]
    wheels: dict[tuple[str, float], tuple[int, float]]
    """Teeth and phase (rad) of gears in the first pose, by body and radius."""

    def ready(self, canvas: Canvas, turned: Mapping[str, float]) -> None:
        """Tell a canvas the turns of springs, and how gears stand whose bodies have turned by angles (rad)."""
        canvas.coils.update(self.coils)
        for (body, radius), (teeth, phase) in self.wheels.items():
            canvas.turned[body, radius] = teeth, phase + teeth * turned[body]


def steady_of(m: Model, poses: Sequence[Pose], colours: dict[str, str], recorder: type[Canvas]) -> Steady:
    """Return the constants of these poses; ``recorder`` is a canvas that needs no axes."""
    low, high, unit = measure_all(m, poses)
    sides = steady_sides(m, poses, unit)
    turns: dict[str, list[int]] = {}
    wheels: dict[tuple[str, float], tuple[int, float]] = {}
    for k, pose in enumerate(poses):
        canvas = recorder(None, unit)
        draw_on(canvas, m, pose, colours, False, sides)
        for name, count in canvas.coils.items():
            turns.setdefault(name, []).append(count)
        if k == 0:
            wheels = dict(canvas.wheels)
    coils = {name: int(np.median(counts)) for name, counts in turns.items()}
    return Steady(low, high, unit, sides, coils, wheels)
