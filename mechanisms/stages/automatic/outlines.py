"""Outlines that touch: the plate of a body has the outline along which it collides, set back by a clearance."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import cadquery as cq
import numpy as np

from mbsd import Mechanism, Outline, Solution
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.outlines.geometry import STRAIGHT, arc_of, depths_in
from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan, build, contact_kind, force_kind
from mechanisms.stages.automatic.layout.planar import Rounded, convex_hull
from mechanisms.stages.automatic.layout.sizes import CLEAR, Extent, extent
from shared.shapes.build import eased, extruded
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Bodies whose outlines touch share a layer. Their plates are the outlines, smaller all round by half a clearance each,
# so that solids of parts that touch in the model are two things that never do. Those of ground are posts on the base.

TOUCH, PUSH = "outline_touch", "outline_force"
WALL = 1.0
"""Solid matter round a place ends this far from the outline (rmm)."""
EASED = 0.3
"""Chamfer of the edges (rmm)."""
PLACES = 41
"""Places along each side of the box around an outline where its middle is looked for."""
SLENDER = 4.0
"""Most radius of the foot of a post of ground, on which the base plate's size depends (rmm)."""


@dataclass(frozen=True, eq=False)
class OutlineSolid(Feature):
    """An outline of a body as a part of its plate, or of ground as a post."""

    outline: Outline
    mates: frozenset[str]
    """Bodies that it touches."""
    centre: tuple[float, float]
    """A place within it (rmm): that of a joint if there is one."""
    round: float
    """Radius of a solid circle about the centre (rmm)."""
    is_held: bool = False
    """True if a joint holds it, or another outline of the body does that overlaps it."""

    @property
    def body(self) -> str:
        """The name of its body."""
        return self.outline.body.name

    @property
    def what(self) -> str:
        """The name of its item."""
        return f"the outline {self.outline.name}"

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return a place for the body's plate to go to, unless the outline is held."""
        eye = min(self.round, layout.sizes.eye)
        return [] if self.is_held else [Anchor(self.body, *self.centre, eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield its convex hull at the height of the plate, or from the base to that of its mates."""
        hull = Rounded(convex_hull(layout.sizes.of_metres(1.0) * self.outline.path()[:-1]), 0.0)
        if self.body == "ground":
            reach = Reach(tuple(sorted(self.mates)), high=0, base=True)
            yield Item(self.what, "ground", hull, reach, self.mates, self, stands=self.what)
        else:
            yield Item(self.what, self.body, hull, Reach((self.body,)), self.mates, self)


@extent(TOUCH)
@extent(PUSH)
def extent_of(thing: Joint | Force, solution: Solution) -> Extent:
    """Return circles round both outlines."""
    both = ((thing.i, thing.params["outline_i"]), (thing.j, thing.params["outline_j"]))
    return Extent(tuple((m, max(math.hypot(x, y) for x, y, _ in corners)) for m, corners in both), ())


@contact_kind(TOUCH)
@force_kind(PUSH)
def gather(m: Mechanism, touches: Sequence[Joint | Force], layout: Layout) -> list[Feature]:
    """Return a feature for each outline of bodies that touch others."""
    if any(isinstance(feature, OutlineSolid) for feature in layout.features):
        return []
    mates: dict[str, set[str]] = {}
    for touch in (*m.contacts.values(), *m.forces.values()):
        if touch.kind.name in (TOUCH, PUSH):
            first, second = touch.bodies
            mates.setdefault(first, set()).add(second)
            mates.setdefault(second, set()).add(first)
    for body, others in mates.items():
        layout.together += list(pairwise(sorted({body, *others} - {"ground"})))
    return [solid for body in mates for solid in _solids(m, body, frozenset(mates[body]), layout)]


def _solids(m: Mechanism, body: str, mates: frozenset[str], layout: Layout) -> list[OutlineSolid]:
    """Return the solids of a body's outlines. Raises UserError for a hole."""
    joints = [marker for joint in m.joints.values() for marker in (joint.i, joint.j) if marker.body.name == body]
    places = [layout.place(marker) for marker in joints]
    solids: list[OutlineSolid] = []
    for outline in (outline for outline in m.outlines.values() if outline.body.name == body):
        if outline.is_hole:
            raise UserError(
                f"{m.name}: outline '{outline.name}' is a hole, which has no automatic parts yet; write "
                f"{shown_file(m.name, 'parts')}"
            )
        path = layout.sizes.of_metres(1.0) * outline.path()
        room, centre = _roomiest(path, places)
        is_held = room > layout.sizes.eye
        if not is_held:
            grid = np.meshgrid(*np.linspace(path.min(axis=0), path.max(axis=0), PLACES).T)
            room, centre = _roomiest(path, np.stack([side.ravel() for side in grid], axis=1).tolist())
        solids.append(OutlineSolid(outline, mates, centre, max(room - WALL, 0.5), is_held))
    for _ in solids:  # what is held holds what overlaps it
        held = [solid for solid in solids if solid.is_held]
        solids = [s if s.is_held else replace(s, is_held=any(_overlap(s, other) for other in held)) for s in solids]
    return solids


def _roomiest(path: np.ndarray, places: Sequence[Sequence[float]]) -> tuple[float, tuple[float, float]]:
    """Return the most room that one of some places has in a closed path, and that place; 0 without any."""
    if not len(places):
        return 0.0, (0.0, 0.0)
    room = depths_in(path, np.array(places))
    most = int(room.argmax())
    return float(room[most]), (float(places[most][0]), float(places[most][1]))


def _overlap(first: OutlineSolid, second: OutlineSolid) -> bool:
    """Return True if a corner of one of two outlines of a body is in the other."""
    paths = first.outline.path(), second.outline.path()
    return any(bool((depths_in(a, b) > 0.0).any()) for a, b in (paths, paths[::-1]))


@build.register(OutlineSolid)
def outline_solid(solid: OutlineSolid, plan: Plan, heights: Heights) -> None:
    """Build the outline as a part of its body's plate, or as a post that stands on the base."""
    sizes = plan.layout.sizes
    wire = wire_of(solid.outline, sizes.of_metres(1.0))
    inner = max(wire.offset2D(-0.5 * CLEAR * sizes.pivot.fit.running), key=lambda w: cq.Face.makeFromWires(w).Area())
    if solid.body == "ground":
        seat = sizes.pivot.fit.seat
        top = max(heights.top(mate) for mate in solid.mates)
        shape = eased(extruded(inner, top - seat, seat), EASED, ">Z", chamfer=True)
        plan.make("ground", f"post_{solid.outline.name}", shape, "brass", 0)
        plan.feet.append(Foot("", *solid.centre, min(solid.round, SLENDER)))
        return
    shape = extruded(inner, heights.thickness)
    plan.plate(solid.body, eased(shape, EASED, chamfer=True), (*solid.centre, solid.round))


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
