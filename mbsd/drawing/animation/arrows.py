"""Arrows and arcs of a clip: velocities, accelerations, forces and reactions, and their scale.

One scale holds for the whole clip and for all quantities of one unit in a picture.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.drawing.animation.words import QUANTITIES, round_below
from mbsd.drawing.pose import Tracks
from mbsd.model.body import Marker
from mbsd.model.mechanism import Model
from mbsd.results.acting import felt
from mbsd.results.force_view import Action
from mbsd.results.solution import Solution
from mbsd.results.views import FrameView


@dataclass(frozen=True)
class Arrow:
    """A vector at a point that may move."""

    quantity: str
    """A word of ``show``."""
    place: np.ndarray
    """(T, 2) where it begins (m)."""
    vector: np.ndarray
    """(T, 2) in its own unit, world axes."""
    middle: bool = False
    """True if ``place`` is the middle of the arrow, not its tail."""
    weight: bool = False
    """True if the force is the weight of a body."""

    @property
    def size(self) -> np.ndarray:
        """(T,)"""
        return np.hypot(*self.vector.T)


@dataclass(frozen=True)
class Arc:
    """A turning quantity about a point; positive counter-clockwise."""

    quantity: str
    place: np.ndarray
    """(T, 2) m."""
    value: np.ndarray
    """(T,) in its own unit."""

    @property
    def size(self) -> np.ndarray:
        """(T,)"""
        return np.abs(self.value)


@dataclass(frozen=True)
class Moving:
    """A marker along a motion, world axes, (T, 2) each."""

    place: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


def moving(view: FrameView, x: float, y: float) -> Moving:
    """Return the point (x, y) of a body whose frame moves like ``view`` (m)."""
    c, s = np.cos(view.theta), np.sin(view.theta)
    arm = np.stack([c * x - s * y, s * x + c * y], axis=1)
    across = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    omega, alpha = view.omega[:, None], view.alpha[:, None]
    return Moving(
        np.stack([view.x, view.y], axis=1) + arm,
        np.stack([view.vx, view.vy], axis=1) + omega * across,
        np.stack([view.ax, view.ay], axis=1) + alpha * across - omega**2 * arm,
    )


def applied(sol: Solution) -> Iterator[tuple[Action, np.ndarray]]:
    """Yield the action of each force on each moving body that it loads, and its place (T, 2) (m)."""
    for view in sol.forces.values():
        for body in view.bodies:
            if body != "ground":
                action = view.on(body)
                yield action, np.stack([action.x, action.y], axis=1)


def moving_marker(views: dict[str, FrameView], marker: Marker) -> Moving:
    """Return the origin of a marker."""
    return moving(views[marker.body.name], marker.x, marker.y)


SAME = 1e-9
"""Fraction of the size of the motion: points that stay closer than this are one."""


def motion_arrows(m: Model, tracks: Tracks, quantity: str) -> list[Arrow | Arc]:
    """Return arrows of ``velocities`` or ``accelerations``.

    A body that turns about a fixed point alone has an arc.
    """
    out: list[Arrow | Arc] = []
    shown: list[Moving] = []
    points = {name: [moving_marker(tracks.views, marker) for marker in _markers(m, name)] for name in m.bodies}
    everywhere = np.concatenate([point.place for several in points.values() for point in several] or [np.zeros((1, 2))])
    slack = SAME * max(float(np.ptp(everywhere, axis=0).max()), 1e-12)
    for name, view in tracks.views.items():
        if name == "ground":
            continue
        moves = [point for point in points[name] if np.ptp(point.place, axis=0).max() > slack]
        for move in moves:
            if any(np.abs(move.place - other.place).max() < slack for other in shown):
                continue
            shown.append(move)
            out.append(Arrow(quantity, move.place, move.velocity if quantity == "velocities" else move.acceleration))
        if not moves and np.ptp(view.theta) > 0:
            pivot = points[name][0] if points[name] else moving(view, *m.bodies[name].com)
            out.append(Arc(quantity, pivot.place, view.omega if quantity == "velocities" else view.alpha))
    return out


def _markers(m: Model, name: str) -> list[Marker]:
    """Return markers of joints and traced points.

    If these are one place, the centre of mass or a bar's end comes too.
    """
    joints = [*m.joints.values(), *(contact for contact in m.contacts.values() if contact.kind.drawn_as == "rope")]
    out = [marker for joint in joints for marker in (joint.j, joint.i) if marker.body.name == name]
    out += [marker for marker in m.traces.values() if marker.body.name == name]
    body = m.bodies[name]
    if len({(marker.x, marker.y) for marker in out}) < 2:
        out.append(body.end if body.length is not None and body.mass == 0 else body.at(*body.com))
    return out


def reaction_arrows(sol: Solution) -> list[Arrow | Arc]:
    """Return the reactions of joints and contacts on the moving body."""
    out: list[Arrow | Arc] = []
    drivers = set(sol.mechanism.drivers.values())
    for k, joint in enumerate(sol.packed.joints):
        if joint not in drivers:
            out += _wrench(sol, k, "reactions")
    return out


def force_arrows(sol: Solution, tracks: Tracks) -> list[Arrow | Arc]:
    """Return forces on each moving body, efforts of drivers on their second body, and weights."""
    m, out = sol.mechanism, []
    for action, place in applied(sol):
        out += [Arrow("forces", place, action.force), Arc("forces", place, action.torque)]
    for k, joint in enumerate(sol.packed.joints):
        if m.drivers.get(joint.name) is joint:
            out += _wrench(sol, k, "forces")
    gravity = np.array(m.gravity, float)
    for name, body in m.bodies.items():
        if name != "ground" and body.mass > 0 and gravity.any():
            centre = moving(tracks.views[name], *body.com).place
            out.append(Arrow("forces", centre, np.broadcast_to(body.mass * gravity, centre.shape), weight=True))
    return out


def _wrench(sol: Solution, k: int, quantity: str) -> list[Arrow | Arc]:
    """Return force and torque of joint number ``k`` on the body that moves."""
    on = felt(sol.packed, sol.q, sol.wrench, k)
    place = np.stack([on.x, on.y], axis=1)
    return [Arrow(quantity, place, on.force), Arc(quantity, place, on.torque)]


USUAL = 97.0
"""Percentile of the largest at each time that sets the scale."""
PEAK = 1.7
"""Peaks up to so many times the usual set it themselves; higher ones are cut."""
LONGEST = 1.35
"""Length of an arrow that is cut, in lengths of the usual largest one."""
FULL_TURN = 1.5 * math.pi
"""Sweep of the largest arc."""
NOTHING = 1e-9
"""Fraction of the largest of all pictures of this unit, or of what is usual: less is rounding and not drawn."""


@dataclass(frozen=True)
class Scale:
    """Scale of one unit in one picture."""

    unit: str
    largest: float
    """Magnitude of an arrow of full length (in ``unit``)."""
    reference: float
    """A round number below, for the legend."""
    cut: bool
    """True if some arrow is longer than it is drawn."""

    def part(self, size: np.ndarray | float) -> np.ndarray:
        """Return the fraction of the full length, at most LONGEST."""
        return np.minimum(np.asarray(size) / self.largest, LONGEST)


def scales_of(marks: Sequence[Arrow | Arc], floor: dict[str, float]) -> dict[str, Scale]:
    """Return the scales by unit; a unit whose arrows are below ``floor``, which is rounding, has none."""
    out = {}
    by_unit: dict[str, list[np.ndarray]] = {}
    for mark in marks:
        by_unit.setdefault(unit_of(mark), []).append(mark.size)
    for unit, sizes in by_unit.items():
        peaks = np.max(sizes, axis=0)
        top, usual = float(peaks.max()), float(np.percentile(peaks, USUAL))
        if not np.isfinite(top) or top <= floor.get(unit, 0.0):
            continue
        usual = usual if usual > 0.02 * top else 0.5 * top  # a short pulse in a motion that is else at rest
        largest = top if top <= PEAK * usual else usual
        out[unit] = Scale(unit, largest, round_below(0.9 * largest), top > LONGEST * largest * (1 + 1e-9))
    return out


def unit_of(mark: Arrow | Arc) -> str:
    """Return the unit of an arrow or an arc."""
    quantity = QUANTITIES[mark.quantity]
    return quantity.turning if isinstance(mark, Arc) else quantity.unit
