"""Outlines that touch: the plate of a body has the outline along which it collides, set back by a clearance."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import cadquery as cq
import numpy as np

from mbsd import Mechanism, Outline, Solution
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.outlines.geometry import STRAIGHT, arc_of
from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Plan, build, contact_kind, force_kind
from mechanisms.stages.automatic.layout.planar import Rounded, convex_hull
from mechanisms.stages.automatic.layout.sizes import CLEAR, Extent, extent
from shared.shapes.build import eased, extruded
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Bodies whose outlines touch share a layer. Their plates are the outlines, smaller all round by half a clearance each,
# so that solids of parts that touch in the model are two things that never do.

TOUCH, PUSH = "outline_touch", "outline_force"
WALL = 1.0
"""Solid matter round a place ends this far from the outline (rmm)."""
EASED = 0.3
"""Chamfer of the edges (rmm)."""


@dataclass(frozen=True, eq=False)
class OutlinePlate(Feature):
    """An outline of a body as a part of its plate."""

    outline: Outline
    mates: frozenset[str]
    """Bodies that it touches."""
    centre: tuple[float, float]
    """A place within it (rmm): that of a joint if there is one."""
    round: float
    """Radius of a solid circle about the centre (rmm)."""
    holds_joint: bool

    @property
    def body(self) -> str:
        """The name of its body."""
        return self.outline.body.name

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return a place for the body's plate to go to, unless a joint within it has one."""
        eye = min(self.round, layout.sizes.eye)
        return [] if self.holds_joint else [Anchor(self.body, *self.centre, eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield its convex hull at the height of the plate."""
        points = layout.sizes.of_metres(1.0) * self.outline.path()[:-1]
        hull = Rounded(convex_hull(points), 0.0)
        what = f"the outline {self.outline.name}"
        yield Item(what, self.body, hull, Reach((self.body,)), self.mates, self)


@extent(TOUCH)
@extent(PUSH)
def extent_of(thing: Joint | Force, solution: Solution) -> Extent:
    """Return circles round both outlines."""
    both = ((thing.i, thing.params["outline_i"]), (thing.j, thing.params["outline_j"]))
    return Extent(tuple((m, max(math.hypot(x, y) for x, y, _ in corners)) for m, corners in both), ())


@contact_kind(TOUCH)
@force_kind(PUSH)
def gather(m: Mechanism, touches: Sequence[Joint | Force], layout: Layout) -> list[Feature]:
    """Return a feature for each outline of a mechanism that touches another one."""
    if any(isinstance(feature, OutlinePlate) for feature in layout.features):
        return []
    mates: dict[str, set[str]] = {}
    for touch in (*m.contacts.values(), *m.forces.values()):
        if touch.kind.name in (TOUCH, PUSH):
            first, second = touch.bodies
            mates.setdefault(first, set()).add(second)
            mates.setdefault(second, set()).add(first)
    pairs = {tuple(sorted((body, other))) for body, others in mates.items() for other in others}
    layout.together += [(a, b) for a, b in sorted(pairs)]
    return [_plate(m, outline, mates, layout) for outline in m.outlines.values() if outline.body.name in mates]


def _plate(m: Mechanism, outline: Outline, mates: dict[str, set[str]], layout: Layout) -> OutlinePlate:
    body = outline.body.name
    if body == "ground":
        raise UserError(
            f"{m.name}: outline '{outline.name}' is on ground, which has no plate in a layer; give it to a body that "
            f"is fixed (weld), or write {shown_file(m.name, 'parts')}"
        )
    if outline.hole:
        raise UserError(
            f"{m.name}: outline '{outline.name}' is a hole, which has no automatic parts yet; write "
            f"{shown_file(m.name, 'parts')}"
        )
    points = layout.sizes.of_metres(1.0) * outline.path()
    joints = [marker for joint in m.joints.values() for marker in (joint.i, joint.j) if marker.body.name == body]
    places = [layout.place(marker) for marker in joints]
    room, centre = max(((_room(points, place), place) for place in places), default=(0.0, (0.0, 0.0)))
    held = room > layout.sizes.eye
    if not held:
        x, y = points[:, 0], points[:, 1]
        grid = [
            (float(u), float(v)) for u in np.linspace(x.min(), x.max(), 41) for v in np.linspace(y.min(), y.max(), 41)
        ]
        room, centre = max((_room(points, place), place) for place in grid)
    return OutlinePlate(outline, frozenset(mates[body]), centre, max(room - WALL, 0.5), held)


def _room(points: np.ndarray, place: tuple[float, float]) -> float:
    """Return how far a place is from a closed path (n, 2), negative outside."""
    a, step = points[:-1], np.diff(points, axis=0)
    to = np.array(place) - a
    share = np.clip((to * step).sum(axis=1) / (step**2).sum(axis=1), 0.0, 1.0)
    far = float(np.hypot(*(to - share[:, None] * step).T).min())
    over = (a[:, 1] > place[1]) != (points[1:, 1] > place[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        cross = a[:, 0] + (place[1] - a[:, 1]) / step[:, 1] * step[:, 0] > place[0]
    return far if int((over & cross).sum()) % 2 else -far


@build.register(OutlinePlate)
def plate_solids(plate: OutlinePlate, plan: Plan, heights: Heights) -> None:
    """Build the outline as a part of its body's plate."""
    sizes = plan.layout.sizes
    wire = wire_of(plate.outline, sizes.of_metres(1.0))
    inner = max(wire.offset2D(-0.5 * CLEAR * sizes.pivot.fit.running), key=lambda w: cq.Face.makeFromWires(w).Area())
    shape = extruded(inner, heights.thickness)
    plan.plate(plate.body, eased(shape, EASED, chamfer=True), (*plate.centre, plate.round))


def wire_of(outline: Outline, metre: float) -> cq.Wire:
    """Return an outline as a wire at z = 0, a ``metre`` as the unit."""
    edges = []
    corners = outline.corners
    for first, second in zip(corners, [*corners[1:], corners[0]], strict=True):
        ends = [cq.Vector(metre * x, metre * y, 0.0) for x, y, _ in (first, second)]
        if abs(first[2]) <= STRAIGHT:
            edges.append(cq.Edge.makeLine(*ends))
            continue
        x, y, radius, sweep = arc_of(first, second)
        angle = math.atan2(first[1] - y, first[0] - x) + 0.5 * sweep
        middle = cq.Vector(metre * (x + radius * math.cos(angle)), metre * (y + radius * math.sin(angle)), 0.0)
        edges.append(cq.Edge.makeThreePointArc(ends[0], middle, ends[1]))
    return cq.Wire.assembleEdges(edges)
