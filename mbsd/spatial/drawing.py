"""A mechanism in space as polylines, in a dimetric view (ISO 5456-3), with the signs of ISO 3952 for its joints.

The view looks along (0.33, 0.88, -0.33): x and z are drawn at full scale, y at half of it, as in engineering dimetric
drawings. A body is its straight lines between joints; signs are drawn in the plane of the picture, along the projected
axis of their joint.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from mbsd.drawing.canvas import Label
from mbsd.drawing.carriers import Carrier, End
from mbsd.drawing.moving_skeleton import SHAPES, Carried, Moving, equal_steps
from mbsd.drawing.skeleton import Steady
from mbsd.drawing.strokes import Stroke, Strokes
from mbsd.spatial.model.body import Marker
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.results.solution import Solution

AZIMUTH, ELEVATION = math.radians(-20.705), math.radians(19.471)
UNIT = 0.022
"""Size of the signs, as a part of the mechanism's size."""
ROUND, RIM = (np.linspace(0.0, 2.0 * math.pi, count + 1)[:-1] for count in (32, 72))
GROUND, INK = "quiet", "ink"


def view_rows() -> np.ndarray:
    """Return the directions right and up of the picture (2, 3)."""
    c, s, ce, se = math.cos(AZIMUTH), math.sin(AZIMUTH), math.cos(ELEVATION), math.sin(ELEVATION)
    return np.array([[c, s, 0.0], [-s * se, c * se, ce]])


def strokes_of(solution: Solution, steps: Sequence[int]) -> list[Strokes]:
    """Return the skeleton at output ``steps``, in signs of one size."""
    return [_Drawing(solution, step).drawn() for step in steps]


def moving(solution: Solution) -> Moving:
    """Return the skeleton for any moment, in the picture (m); ends of its carriers are points of bodies in space."""
    steps = equal_steps(solution.t, SHAPES)
    drawn = strokes_of(solution, [int(step) for step in steps])
    first = drawn[0]
    strokes = [
        Carried(stroke, stroke.carrier)
        if stroke.carrier
        else Carried(stroke, Carrier("shapes"), [pose.strokes[k].points for pose in drawn])
        for k, stroke in enumerate(first.strokes)
    ]
    names = [(label, label.carrier) for label in first.labels if label.carrier is not None]
    everything = np.concatenate([stroke.points for pose in drawn for stroke in pose.strokes])
    steady = Steady(everything.min(axis=0), everything.max(axis=0), first.unit, {}, {}, {})
    return Moving(strokes, names, solution.t[steps], steady)


def _end(marker: Marker) -> End:
    x, y, z = marker.place
    return End(marker.body.name, x, y, z)


class _Drawing:
    """One pose."""

    def __init__(self, solution: Solution, step: int) -> None:
        self.m: Model = solution.mechanism
        self.time = float(solution.t[step])
        self.unit = UNIT * solution.packed.size
        self.rows = view_rows()
        self.poses = {"ground": (np.zeros(3), np.eye(3))}
        for name in solution.packed.body_names[1:]:
            view = solution.body(name)
            self.poses[name] = view.place[step], view.rotation[step]
        self.strokes: list[Stroke] = []

    def drawn(self) -> Strokes:
        """Return all strokes and names."""
        labels = []
        for name in self.m.bodies:
            self._body(name)
        for joint in self.m.joints.values():
            if not joint.coupled:
                self._joint(joint)
                labels.append(self._label(joint.name, _end(joint.j), 2.2, INK))
        for force in self.m.forces.values():
            if force.pushes[0].row.terms[0].kind == "distance":
                self._spring(_end(force.i), _end(force.j))
        for name, marker in self.m.traces.items():
            self._ring(_end(marker), 0.35, f"body:{marker.body.name}", 1.9, "paper")
            labels.append(self._label(name, _end(marker), 1.4, f"body:{marker.body.name}"))
        return Strokes(self.time, self.strokes, labels, self.unit)

    def _label(self, text: str, end: End, clearance: float, ink: str) -> Label:
        return Label(text, self._flat(self._place(end)), clearance, ink, 10.0, Carrier("place", (end,)))

    # -- bodies -------------------------------------------------------------------------------------------------

    def _body(self, name: str) -> None:
        ends = [_end(marker) for marker in self._markers(name)]
        if name == "ground":
            for end in ends:
                self._hatched(self._flat(self._place(end)))
            return
        ink, shape = f"body:{name}", self.m.bodies[name].shape
        r, turned = self.poses[name]
        if shape is not None and shape.kind == "rod":
            ends += [End(name, 0.0, 0.0, 0.0), End(name, shape.length, 0.0, 0.0)]
        if shape is not None and shape.kind in ("disc", "ball"):
            rim = self._circle(r, turned[:, 0], shape.radius, shape.kind == "ball")
            self._add(rim, ink, 2.0, 1.2, fill=ink, alpha=0.12, closed=True)
        places = np.array([(end.x, end.y, end.z) for end in ends], float).reshape(-1, 3)
        apart = [k for k, p in enumerate(places) if (np.linalg.norm(places[:k] - p, axis=1) > 0.2 * self.unit).all()]
        if len(apart) == 2:
            self._line(ends[apart[0]], ends[apart[1]], ink)
        elif len(apart) > 2:
            x, y, z = places[apart].mean(axis=0)
            centre = End(name, float(x), float(y), float(z))
            for k in apart:
                self._line(centre, ends[k], ink)
        if self.m.bodies[name].mass > 0.0 and len(apart) < 2:
            x, y, z = self.m.bodies[name].com
            middle = End(name, float(x), float(y), float(z))
            for k in apart:
                self._line(ends[k], middle, ink)
            self._ring(middle, 0.7, ink, 1.5, ink)

    def _markers(self, name: str) -> Iterator[Marker]:
        for element in (*self.m.joints.values(), *self.m.forces.values()):
            if isinstance(element, Joint) and element.coupled:
                continue
            yield from (marker for marker in (element.i, element.j) if marker.body.name == name)

    def _circle(self, centre: np.ndarray, axis: np.ndarray, radius: float, is_ball: bool) -> np.ndarray:
        """Return the outline of a ball or disc; its points lie alike in all poses, however fast a disc turns."""
        seen = self.rows @ axis
        flat = math.hypot(*seen)
        along = seen / flat if flat > 1e-9 else np.array([1.0, 0.0])
        depth = 1.0 if is_ball else math.sqrt(max(1.0 - flat**2, 0.0))
        rim = np.outer(depth * np.cos(RIM), along) + np.outer(np.sin(RIM), [-along[1], along[0]])
        return self._flat(centre) + radius * rim

    # -- signs --------------------------------------------------------------------------------------------------

    def _joint(self, joint: Joint) -> None:
        kind, end = joint.kind.name, _end(joint.j)
        place = self._place(end)
        ink = f"body:{joint.j.body.name}" if joint.j.body.name != "ground" else INK
        if kind in ("revolute", "cylindrical", "prismatic", "screw"):
            self._barrel(joint, place, ink, {"revolute": 1.0, "screw": 1.8}.get(kind, 1.8))
            if kind in ("prismatic", "screw"):
                self._across(joint, place, ink, 2 if kind == "screw" else 1)
        elif kind in ("spherical", "distance", "rod_with_fork"):
            for ball in (joint.i, joint.j) if kind != "spherical" else (joint.j,):
                self._ring(_end(ball), 0.75, ink, 2.2, "paper")
            if kind != "spherical":
                self._line(_end(joint.i), end, INK)
        elif kind in ("universal", "constant_velocity"):
            for marker in (joint.i, joint.j):
                arm = 1.5 * self.unit * (self.poses[marker.body.name][1] @ np.array(marker.axis))
                self._add(self._flat(np.array([place - arm, place + arm])), INK, 2.3, 2.2)
            self._ring(end, 0.5, INK, 2.4, "paper")
        else:
            self._ring(end, 0.5, ink, 2.2, ink)

    def _barrel(self, joint: Joint, place: np.ndarray, ink: str, half: float) -> None:
        along, across = self._axis(joint)
        corners = [(half, 0.75), (-half, 0.75), (-half, -0.75), (half, -0.75)]
        outline = np.array([self._flat(place) + self.unit * (u * along + v * across) for u, v in corners])
        self._add(outline, ink, 2.1, 1.6, fill="paper", alpha=1.0, closed=True)
        ends = np.array([self._flat(place) + s * (half + 0.7) * self.unit * along for s in (-1.0, 1.0)])
        self._add(ends, ink, 2.2, 1.0, dash=(6.0, 2.0, 1.0, 2.0))

    def _across(self, joint: Joint, place: np.ndarray, ink: str, count: int) -> None:
        along, across = self._axis(joint)
        for k in range(count):
            at = self._flat(place) + (k - (count - 1) / 2) * self.unit * along
            self._add(np.array([at - 0.75 * self.unit * across, at + 0.75 * self.unit * across]), ink, 2.3, 1.2)

    def _axis(self, joint: Joint) -> tuple[np.ndarray, np.ndarray]:
        """Return the axis of a joint in the picture (2,) at the scale of its view, and the unit vector across it."""
        along = self.rows @ (self.poses[joint.i.body.name][1] @ np.array(joint.i.axis))
        length = float(np.linalg.norm(along))
        unit = along / length if length > 0.05 else np.array([1.0, 0.0])
        return max(length, 0.25) * unit, np.array([-unit[1], unit[0]])

    def _spring(self, start: End, end: End) -> None:
        a, b = (self._flat(self._place(place)) for place in (start, end))
        along = b - a
        across = np.array([-along[1], along[0]]) / max(float(np.linalg.norm(along)), 1e-12)
        parts = [0.0, 0.15, *np.linspace(0.18, 0.82, 9), 0.85, 1.0]
        sides = [0.0, 0.0, *(0.7 * (-1.0) ** k for k in range(9)), 0.0, 0.0]
        path = np.array([a + t * along + s * self.unit * across for t, s in zip(parts, sides, strict=True)])
        self._add(path, "load", 1.8, 1.4, carrier=Carrier("line", (start, end)))

    def _hatched(self, at: np.ndarray) -> None:
        u, right = self.unit, np.array([self.unit, 0.0])
        below = at - np.array([0.0, 1.3 * u])
        still = Carrier("ground")
        self._add(np.array([below - 1.6 * right, below + 1.6 * right]), GROUND, 1.0, 1.4, carrier=still)
        self._add(np.array([at, below]), GROUND, 1.0, 1.4, carrier=still)
        for k in range(4):
            top = below + (-1.2 + 0.8 * k) * right
            self._add(np.array([top, top - np.array([0.5 * u, 0.6 * u])]), GROUND, 1.0, 1.0, carrier=still)

    def _ring(self, end: End, radius: float, ink: str, order: float, fill: str) -> None:
        at = self._flat(self._place(end))
        circle = at + radius * self.unit * np.stack([np.cos(ROUND), np.sin(ROUND)], axis=1)
        self._add(circle, ink, order, 1.6, fill=fill, alpha=1.0, closed=True, carrier=Carrier("place", (end,)))

    def _line(self, start: End, end: End, ink: str) -> None:
        points = np.array([self._flat(self._place(place)) for place in (start, end)])
        self._add(points, ink, 1.5, 2.6, carrier=Carrier("line", (start, end)))

    def _add(
        self, points: np.ndarray, ink: str, order: float, width: float, fill: str | None = None, alpha: float = 1.0,
        closed: bool = False, dash: tuple[float, ...] = (), carrier: Carrier | None = None,
    ) -> None:  # fmt: skip
        points = np.asarray(points, float)
        self.strokes.append(Stroke(points, closed, ink, fill, alpha, width, order, dash, carrier=carrier))

    def _place(self, end: End) -> np.ndarray:
        place, turned = self.poses[end.body]
        return place + turned @ np.array([end.x, end.y, end.z or 0.0])

    def _flat(self, places: np.ndarray) -> np.ndarray:
        return places @ self.rows.T
