"""Where every body's frame is at one moment: of a model at its start, or of a solution at a step."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import AssemblyError, ModelError
from mbsd.base.names import shown
from mbsd.model.body import Marker
from mbsd.model.mechanism import Model
from mbsd.results.rows import released_rows

if TYPE_CHECKING:
    from mbsd.model.force import Force
    from mbsd.model.joint import Joint
    from mbsd.results.solution import Solution
    from mbsd.results.views import FrameView


@dataclass(frozen=True)
class Pose:
    """Frames of all bodies (m, rad) in the author's sense, ground included."""

    frames: dict[str, tuple[float, float, float]]
    title: str
    closed: bool = True
    paths: dict[str, np.ndarray] = field(default_factory=dict)
    """(T, 2) of traced points."""
    travel: dict[str, np.ndarray] = field(default_factory=dict)
    """(T,) place of a joint's second marker along the axis of the first (m); ``force spring``, ``contact floor``. Of a
    joint that is released it ends there."""
    aside: dict[str, np.ndarray] = field(default_factory=dict)
    """(T,) the same across that axis, to its left (m)."""
    released: Mapping[str, bool] = field(default_factory=dict)
    """Joints and drivers that an event releases, and whether that has happened."""

    def gone(self, joint: str) -> bool:
        """Return True if a joint or driver has been released."""
        return self.released.get(joint, False)

    def place(self, marker: Marker) -> np.ndarray:
        """Return (2,) of a marker in the world (m)."""
        return self.point(marker.body.name, marker.x, marker.y)

    def point(self, body: str, x: float, y: float) -> np.ndarray:
        """Return (2,) of a point of a body (m)."""
        x0, y0, theta = self.frames[body]
        c, s = math.cos(theta), math.sin(theta)
        return np.array([x0 + c * x - s * y, y0 + s * x + c * y])

    def axis(self, marker: Marker) -> np.ndarray:
        """Return (2,) unit x axis of a marker in the world."""
        angle = self.frames[marker.body.name][2] + marker.angle
        return np.array([math.cos(angle), math.sin(angle)])


def start_pose(m: Model) -> Pose:
    """Return the closed start pose; the rough one, said not to be closed, if the links do not reach."""
    from mbsd.arrays.packing import pack
    from mbsd.kinematics.pose.close import assemble, rough_pose

    packed = pack(m)
    closed = True
    try:
        q = assemble(m, packed, 0.0)
    except AssemblyError:
        closed = False
        q = rough_pose(m, packed, packed.drives(np.zeros(1))[0], 0)
    q = q.reshape(-1, 3)
    frames = {}
    for b, name in enumerate(packed.body_names):
        c, s = math.cos(q[b, 2]), math.sin(q[b, 2])
        x, y = packed.com[b]
        frames[name] = (float(q[b, 0] - c * x + s * y), float(q[b, 1] - s * x - c * y), float(q[b, 2]))
    return Pose(frames, "" if closed else "the joints in red do not close", closed)


def pose_of(sol: Solution, t: float | None, step: int | None) -> Pose:
    """Return the pose at time ``t`` (s; the nearest output) or at output ``step``; the first by default."""
    m = sol.mechanism
    if t is not None and step is not None:
        raise ModelError(f"{m.name}: give a time t or a step to draw, not both")
    if t is not None:
        t = finite_number(f"{m.name}: time t (s)", t)
        slack = 1e-9 * float(np.ptp(sol.t))
        if not sol.t[0] - slack <= t <= sol.t[-1] + slack:
            raise ModelError(f"{m.name}: t = {t} s is outside of the solution, {sol.t[0]:g} .. {sol.t[-1]:g} s")
        step = int(np.argmin(np.abs(sol.t - t)))
    step = 0 if step is None else step
    if isinstance(step, bool) or not isinstance(step, int | np.integer) or not -len(sol.t) <= step < len(sol.t):
        raise ModelError(f"{m.name}: step is {shown(step)}; the solution has steps 0 .. {len(sol.t) - 1}")
    return tracks_of(sol).pose(step)


@dataclass(frozen=True)
class Tracks:
    """The motion of everything that is drawn, looked up once for many poses."""

    times: np.ndarray
    views: dict[str, FrameView]
    """Frames of bodies, ground included."""
    paths: dict[str, np.ndarray]
    """See :class:`Pose`."""
    travel: dict[str, np.ndarray]
    """See :class:`Pose`."""
    aside: dict[str, np.ndarray]
    """See :class:`Pose`."""
    released: dict[str, np.ndarray]
    """(T,) of each joint and driver that an event releases: whether that has happened."""

    def pose(self, step: int) -> Pose:
        """Return the pose at one of the times."""
        frames = {n: (float(v.x[step]), float(v.y[step]), float(v.theta[step])) for n, v in self.views.items()}
        released = {name: bool(gone[step]) for name, gone in self.released.items()}
        return Pose(frames, f"t = {self.times[step]:.4g} s", True, self.paths, self.travel, self.aside, released)


def tracks_of(sol: Solution) -> Tracks:
    """Return the tracks of a whole solution."""
    m = sol.mechanism
    views = {name: sol.body(name) for name in m.bodies}
    travel, aside, released = {}, {}, released_rows(sol)
    for name, joint in _markers_of(m).items():
        first, second = views[joint.i.body.name], views[joint.j.body.name]
        gap = _path(second, joint.j) - _path(first, joint.i)
        angle = first.theta + joint.i.angle
        c, s = np.cos(angle), np.sin(angle)
        travel[name] = gap[:, 0] * c + gap[:, 1] * s
        aside[name] = gap[:, 1] * c - gap[:, 0] * s
        if name in released and not released[name].all():
            travel[name], aside[name] = (along[name][~released[name]] for along in (travel, aside))
    points = {name: sol.point(name) for name in m.traces}
    paths = {name: np.stack([view.x, view.y], axis=1) for name, view in points.items()}
    return Tracks(sol.t, views, paths, travel, aside, released)


def _markers_of(m: Model) -> dict[str, Joint | Force]:
    """Return all that has two markers, by key.

    Keys of forces and contacts say so, since joints may have the same names.
    """
    forces = {f"force {name}": force for name, force in m.forces.items()}
    return {**m.joints, **m.drivers, **forces, **{f"contact {name}": contact for name, contact in m.contacts.items()}}


def _path(view: FrameView, marker: Marker) -> np.ndarray:
    """Return (T, 2) of a marker, from the motion of its body's frame."""
    c, s = np.cos(view.theta), np.sin(view.theta)
    return np.stack([view.x + c * marker.x - s * marker.y, view.y + s * marker.x + c * marker.y], axis=1)
