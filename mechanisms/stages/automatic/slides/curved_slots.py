"""Point on a curve: a slot along the part that the pin's roller runs through, or a groove all round.

A closed curve that is run all round would cut its plate in two, so it is a groove in the face that the pin comes from.
Where the point keeps a distance from the curve, the slot is at that distance. Beyond the ends of an open curve it goes
on straight. A slot that comes to itself has no parts: where it crosses itself no wall would hold the roller, and what
lies within the loop would fall out of the plate.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline

from mbsd import Mechanism, Solution
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout.curves import continued, curve_path, end_ways, evenly, followed, on_body
from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Plan, build, kind
from mechanisms.stages.automatic.layout.planar import convex_hull, disc
from mechanisms.stages.automatic.layout.sizes import Extent, extent
from mechanisms.stages.automatic.slides.slots import Slot, channelled, entered, slotted
from shared.shapes.outline import normals, sharpest
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

STEP, MOST, FINEST = 2.0, 240, 960
"""Between places of a slot (rmm), and how many there are at most; as many as FINEST where fewer would stray."""
STRAY = 1 / 8
"""How far the spline through these places may stray from the curve, in the roller's clearance."""
BEYOND = 1.0
"""The slot's way beyond the pin's, at either end (rmm)."""
BEND = 1.25
"""Least radius of curvature, in radii of the roller."""
LEAST = 9.0
"""The same, in rmm."""
BETWEEN = 2.0
"""Least wall between two stretches of a slot (rmm)."""


@dataclass(frozen=True, eq=False)
class CurvedSlot(Slot):
    """``path`` is at even steps; closed: its last place is its first."""

    closed: bool

    @property
    def runs_through(self) -> Slot | None:
        """None where it is a groove all round."""
        return None if self.closed else self

    def posts(self, layout: Layout) -> list[tuple[float, float]]:
        """Return posts of a plate on ground: beyond the two places that are farthest from each other."""
        hull = convex_hull(self.path)
        apart = np.linalg.norm(hull[:, None] - hull[None], axis=2)
        a, b = np.unravel_index(int(np.argmax(apart)), apart.shape)
        return Slot.posts(Slot(self.name, self.slot, self.pin, hull[[a, b]], self.pin_at), layout)

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return a wall round the slot, whole in its middle; an eye that holds the pin."""
        if self.slot == "ground":
            return Slot.anchors(self, layout)
        thinned = self.path[:: max(1, len(self.path) // 24)]
        hull, radius = convex_hull(np.vstack([thinned, self.path[-1:]])), self.radius(layout)
        places = [Anchor(self.slot, float(x), float(y), radius) for x, y in [*hull, hull.mean(axis=0)]]
        return [*places, Anchor(self.pin, *self.pin_at, layout.sizes.eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield items as for a straight slot; in a groove the pin ends."""
        for item in Slot.items(self, layout):
            if self.closed and item.body == self.pin and isinstance(item.reach, Reach) and item.reach.high == 1:
                base = self.pin == "ground"
                reach = Reach(self.layers, high=-1, base=True) if base else Reach(self.layers, 1, -1)
                shape = disc(*self.pin_at, layout.sizes.hardware)
                yield replace(item, shape=shape, reach=reach)
            else:
                yield item


@build.register(CurvedSlot)
def curved_slot_solids(slot: CurvedSlot, plan: Plan, heights: Heights) -> None:
    """Slot or groove, pin and roller."""
    (channelled if slot.closed else slotted)(slot, plan, heights)


@kind("point_on_curve")
def gather(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """Return one feature for each joint. Raises UserError where the curve bends too sharply for a roller."""
    return [entered(_slot(m, joint, layout), layout) for joint in joints]


def _slot(m: Mechanism, joint: Joint, layout: Layout) -> CurvedSlot:
    slot, pin, pin_at = joint.i.body.name, joint.j.body.name, layout.place(joint.j)
    whole, seen = on_body(_offset(joint), joint.i, layout), layout.seen(pin, pin_at, slot)
    ways = None if joint.params["closed"] else end_ways(joint.params["points"], joint.i)
    path, closed = _run_through(whole, ways, seen, layout)
    bend, least = sharpest(path), BEND * layout.sizes.roller / 2
    if bend < least:
        scale = layout.sizes.scale
        raise UserError(
            f"{m.name}: the curve of joint '{joint.name}' bends with a radius of {bend * scale:.3g} mm where its pin "
            f"runs; a slot for a roller of {layout.sizes.roller * scale:.3g} mm needs {least * scale:.3g} mm; make "
            "the curve smoother or pins thinner (automatic(m, pin=...))"
        )
    _refuse_near_itself(m, joint, path, closed, layout)
    return CurvedSlot(joint.name, slot, pin, path, pin_at, closed)


def _refuse_near_itself(m: Mechanism, joint: Joint, path: np.ndarray, closed: bool, layout: Layout) -> None:
    """Raise UserError where two stretches of a slot come so near that no wall is left between them."""
    sizes = layout.sizes
    roller, apart = sizes.roller, sizes.roller + sizes.pivot.fit.running + BETWEEN
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    between = np.abs(way[:, None] - way)
    if closed:
        between = np.minimum(between, way[-1] - between)
    away = np.linalg.norm(path[:, None] - path, axis=2)
    away[between < np.pi * max(BEND * roller, apart) / 2] = np.inf  # on a bend that a slot may have, places are nearer
    first, second = np.unravel_index(int(np.argmin(away)), away.shape)
    if away[first, second] >= apart:
        return
    scale, body, (x, y) = sizes.scale, joint.i.body.name, (path[first] + path[second]) / 2 * sizes.scale
    raise UserError(
        f"{m.name}: the pin of joint '{joint.name}' crosses its own path, or comes within "
        f"{away[first, second] * scale:.3g} mm of it, near ({x:.4g}, {y:.4g}) mm in the frame of '{body}'; "
        f"a slot for its roller of {roller * scale:.3g} mm needs {apart * scale:.3g} mm between two stretches; let "
        "the motion end before, make pins thinner (automatic(m, pin=...)), part the stretches of the curve and of its "
        f"straight continuations, or write {shown_file(m.name, 'parts')}"
    )


def _offset(joint: Joint) -> np.ndarray:
    """Return (n, 2) places (m) at the joint's distance from its curve, in the axes of the curve's marker."""
    path = curve_path(joint.params["points"], bool(joint.params["closed"]))
    if joint.params["closed"]:
        path = np.vstack([path, path[:1]])
    path = evenly(path, 4 * len(path))
    return path + joint.params["distance"] * normals(path)


def _run_through(
    whole: np.ndarray, ways: np.ndarray | None, seen: np.ndarray, layout: Layout
) -> tuple[np.ndarray, bool]:
    """Return the part of a path where the pin comes, and True if that is all of a loop.

    The part has a little more at its ends.

    ``ways`` lead on from both ends of an open path.
    """
    step, clearance = float(np.hypot(*np.diff(whole, axis=0).T).max()), layout.sizes.pivot.fit.running
    more = int(BEYOND / step) + 1
    if ways is not None:
        ahead = float(np.linalg.norm(seen[:, None] - whole[[0, -1]], axis=2).max()) + more * step
        whole, _ = continued(whole, ways, ahead, step)
        nearest = followed(whole, seen, False)
        low, high = max(0, nearest.min() - more), min(len(whole) - 1, nearest.max() + more)
        return _stepped(whole[low : high + 1], clearance), False
    count, turns = len(whole) - 1, followed(whole, seen, True)
    low, high = int(turns.min()) - more, int(turns.max()) + more
    between = (count - (high - low)) * step
    if between < layout.sizes.roller + 7.0:
        return _stepped(whole, clearance), True
    return _stepped(whole[np.arange(low, high + 1) % count], clearance), False


def _stepped(path: np.ndarray, clearance: float) -> np.ndarray:
    """Return a path at even steps, as few as keep the roller's ``clearance`` (rmm) along the path."""
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    count = min(MOST, max(8, int(way[-1] / STEP)))
    while True:
        points = evenly(path, count)
        off = CubicSpline(np.linspace(0.0, way[-1], count), points)(way) - path
        if count >= FINEST or np.abs((off * normals(path)).sum(axis=1)).max() < STRAY * clearance:
            return points
        count = min(2 * count, FINEST)


@extent("point_on_curve")
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """Return the room for a roller where the curve bends."""
    bend = sharpest(_offset(joint))
    return Extent((), ((bend, LEAST),) if np.isfinite(bend) else ())
