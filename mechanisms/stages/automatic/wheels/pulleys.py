"""Pulleys and belts, with their solids."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import cadquery as cq
import numpy as np

from mbsd import Mechanism, Solution
from mbsd.model.body import Marker
from mbsd.model.joint import Joint
from mbsd.model.teeth import with_radii
from mechanisms.stages.automatic.layout.items import Heights, Item, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Plan, build
from mechanisms.stages.automatic.layout.planar import Rounded
from mechanisms.stages.automatic.layout.sizes import Extent, Sizes, extent
from mechanisms.stages.automatic.wheels.wheels import TUBE, Wheel, build_wheel, shape_of, with_hub
from shared.contract.geometry import BeltPath
from shared.shapes.build import extruded, turned
from shared.shapes.involute import wire
from shared.shapes.link import Eye
from shared.shapes.outline import circle
from shared.shapes.solid import Hold, Solid, placed
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Pulleys: wheels with a rim for a round belt, or for a chain where the joint has teeth; what the belt needs of room.
#
# The rim is a piece of its own and says where the film lays the belt (render/film/tubes/belts.py), which is no solid:
# its strands keep other parts out of their layer, and the clearance knows it as a band (stages/clearance/meshing.py).

LEAST = 19.0
"""Least pitch radius of a pulley (rmm)."""
BELT = 1.8
"""Radius of a round belt (rmm)."""
RIM = 5.5
"""From the pitch circle in to where the rim begins."""
TOOTH = 0.3
"""Height of a sprocket's teeth above the pitch circle, in pitches, and depth of their spaces below it."""
WALL = 0.3
"""Least width of a disc outside a tube, or outside what turns about a pin (rmm)."""
STAYS = 0.02
"""A strand is at rest in a body if the centres move by less in it (rmm)."""


@dataclass(eq=False)
class Pulley(Wheel):
    """A pulley; with ``teeth`` a sprocket. Only its pitch radius and what is inside of it are a wheel's."""

    belt: str = ""

    @property
    def what(self) -> str:
        """In messages."""
        return f"the pulley of {self.body} at {self.name}"

    @property
    def root(self) -> float:
        """Where the rim begins."""
        return self.radius - RIM - self.tooth

    @property
    def tooth(self) -> float:
        """Height of a sprocket's teeth above the pitch circle, and depth of their spaces below it."""
        return TOOTH * 2 * math.pi * self.radius / self.teeth if self.teeth else 0.0

    @property
    def lip(self) -> float:
        """The rim's outer radius."""
        return self.radius + (self.tooth if self.teeth else 0.6 * BELT)


@dataclass(frozen=True, eq=False)
class Belt(Feature):
    """The strands of a belt between two pulleys: what must stay out of their way."""

    name: str
    pulleys: tuple[Pulley, Pulley]
    crossed: bool

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield both strands, in a body in which they rest; none where there is no such body."""
        first, second = self.pulleys
        for body in layout.poses:
            ends = [layout.seen(pulley.body, (pulley.x, pulley.y), body) for pulley in self.pulleys]
            if max(float(np.ptp(end, axis=0).max()) for end in ends) > STAYS:
                continue
            a, b = ends[0][0], ends[1][0]
            away = float(np.hypot(*(b - a)))
            turn, radius = math.atan2(b[1] - a[1], b[0] - a[0]), second.radius
            lean = math.acos(min(max((first.radius + (radius if self.crossed else -radius)) / away, -1.0), 1.0))
            names = frozenset(pulley.what for pulley in self.pulleys)
            for side in (1.0, -1.0):
                u = np.array([math.cos(turn + side * lean), math.sin(turn + side * lean)])
                core = np.array([a + first.radius * u, b + (-radius if self.crossed else radius) * u])
                shape = Rounded(core, 2 * BELT)
                yield Item(f"the belt of {self.name}", body, shape, Reach((first.layer,)), source=self, meshes=names)
            return


# The solids of pulleys (rmm): a disc with a web, and the rim round it, grooved for a round belt or cut for a chain.

EDGE, FLOOR = 0.7, 1.3
"""Width that stays beside a groove, and half the width of the groove's floor."""
MARKS, LEAST_MARK, LARGEST_MARK = 3, 1.0, 2.5
"""Small holes between hub and rim, and their radii."""
SPROCKET = 0.45
"""Thickness of a sprocket's teeth as a part of the plate's."""
SEAT = 5
"""Points of a sprocket's seat for a roller."""


@shape_of.register(Pulley)
def pulley_disc(pulley: Pulley, thickness: float, eyes: list[tuple[float, float, Eye]]) -> tuple[cq.Workplane, int]:
    """Return the disc of a pulley from z = 0 up, with its eyes, and its number of through holes.

    One without windows has small holes, so that one sees it turn.
    """
    shape, holes = with_hub(extruded(circle(0, 0, pulley.root), thickness), pulley.root, thickness, eyes)
    tubes = [eye.radius for _, _, eye in eyes if eye.bore == 0]  # they would close holes that they stand on
    inner = max([Sizes.hardware, *tubes])
    room = pulley.root - inner
    if holes > 1 or 0.3 * room < LEAST_MARK or any(math.hypot(x, y) > 0.01 for x, y, _ in eyes):
        return shape, holes
    for k in range(MARKS):
        tool = extruded(circle(pulley.root - 0.5 * room, 0, min(0.3 * room, LARGEST_MARK)), thickness + 2.0, -1.0)
        shape = shape.cut(placed(tool, turn=360.0 * k / MARKS))
    return shape, holes + MARKS


@build.register(Pulley)
def build_pulley(pulley: Pulley, plan: Plan, heights: Heights) -> None:
    """Build the disc and rim."""
    build_wheel(pulley, plan, heights)
    build_rim(pulley, plan, heights)


def build_rim(pulley: Pulley, plan: Plan, heights: Heights) -> None:
    """Build the rim about its disc."""
    seat = plan.layout.sizes.pivot.fit.seat
    plan.add(pulley.body, rim_of(pulley, heights.thickness, heights.bottom(pulley.layer), seat))


def rim_of(pulley: Pulley, thickness: float, z: float, seat: float) -> Solid:
    """Return the rim of a pulley from z up, ``seat`` around its disc."""
    inner = pulley.root + seat
    middle, radius = z + thickness / 2, BELT
    if pulley.teeth:
        height = SPROCKET * thickness
        outline = wire(sprocket_outline(pulley.teeth, pulley.radius, pulley.tooth, pulley.phase or 0.0))
        shape = extruded(outline, height, (thickness - height) / 2, [circle(0, 0, inner)])
        radius = min(pulley.tooth, BELT)
    else:
        floor, lip = pulley.radius - 1.1 * BELT, pulley.lip
        groove = [(lip, thickness - EDGE), (floor, thickness / 2 + FLOOR), (floor, thickness / 2 - FLOOR), (lip, EDGE)]
        shape = turned([(inner, 0.0), (inner, thickness), (lip, thickness), *groove, (lip, 0.0)])
    hold = Hold(pulley.belt, middle, radius)
    material = "steel" if pulley.teeth else "aluminium"
    rim = placed(shape, pulley.x, pulley.y, z)
    return Solid(f"rim_{pulley.name}", rim, material, 1, holds=(hold,))


def sprocket_outline(teeth: int, radius: float, tooth: float, phase: float) -> np.ndarray:
    """Return (n, 2) an outline: round seats for rollers on the pitch circle, and teeth between them.

    The first seat is at the angle ``phase``.
    """
    seat, pitch = 0.95 * tooth, 2 * math.pi / teeth
    turn = np.linspace(-100.0, 100.0, SEAT) * math.pi / 180 + math.pi  # about the roller, inner half
    bed = np.stack([radius + seat * np.cos(turn), seat * np.sin(turn)], axis=1)[::-1]
    tip, half = radius + tooth, 0.12 * pitch
    crest = [(tip * math.cos(a), tip * math.sin(a)) for a in (pitch / 2 - half, pitch / 2 + half)]
    span = np.concatenate([bed, crest])
    angles = phase + pitch * np.arange(teeth)
    return np.concatenate([span @ np.array([[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]]) for a in angles])


# Belts and chains: pulleys on their bodies, in one layer, and the room of the strands between them.

BELTS = "belt"


@extent(BELTS)
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """Return both pulleys; those of few teeth are larger, as their spaces leave less of the disc."""
    sized, teeth = with_radii(joint.params), joint.params.get("teeth") or (0, 0)
    both = (joint.i, sized["radius_i"]), (joint.j, sized["radius_j"])
    least = [
        max(LEAST, _least_of_teeth(count, _may_be_on_tube(joint, marker, solution.mechanism))) if count else LEAST
        for (marker, _), count in zip(both, teeth, strict=True)
    ]
    return Extent(both, tuple((radius, low) for (_, radius), low in zip(both, least, strict=True)))


def _least_of_teeth(teeth: int, on_tube: bool) -> float:
    """Return the least pitch radius (rmm) of a sprocket with that many teeth whose disc holds its tube, or its pin."""
    root = (TUBE[1] if on_tube else Sizes.hardware) + WALL
    return (root + RIM) / (1.0 - TOOTH * 2 * math.pi / teeth)


def _may_be_on_tube(joint: Joint, marker: Marker, m: Mechanism) -> bool:
    """Return True if its body has more than this pulley and what is on its axis: then it may lie in its own layer."""
    body = marker.body
    others = [other for other in (*m.joints.values(), *m.forces.values()) if other is not joint]
    ends = [end for other in others for end in (other.i, other.j) if end.body is body]
    wheels = any(
        other.kind.pair != "pin" for other in m.joints.values() if other is not joint and body.name in other.bodies
    )
    aside = any((end.x, end.y) != (marker.x, marker.y) for end in (*ends, *m.traces.values()) if end.body is body)
    return wheels or aside or body.length is not None


def belts(m: Mechanism, layout: Layout) -> list[Belt]:
    """Return all belts of the mechanism, with their pulleys. Raises UserError where two pulleys overlap."""
    return [belt_of(m, joint, layout) for joint in m.joints.values() if joint.kind.name == BELTS]


def belt_of(m: Mechanism, joint: Joint, layout: Layout) -> Belt:
    """Return the belt of a joint, with its pulleys. Raises UserError where these overlap."""
    pair = _pulley(joint, 0, layout), _pulley(joint, 1, layout)
    _fit(m, joint, pair, layout)
    for pulley, mate in (pair, pair[::-1]):
        pulley.mates.append(mate)
    return Belt(joint.name, pair, bool(joint.params["crossed"]))


def _pulley(joint: Joint, end: int, layout: Layout) -> Pulley:
    sized, marker = with_radii(joint.params), (joint.i, joint.j)[end]
    (x, y), radius = layout.place(marker), layout.sizes.of_metres(sized[("radius_i", "radius_j")[end]])
    teeth = (joint.params.get("teeth") or (0, 0))[end]
    name = f"{joint.name}_{marker.body.name}"
    made = Pulley(name, marker.body.name, x, y, radius, teeth=teeth, belt=joint.name)
    made.tip = made.lip
    return made


def _fit(m: Mechanism, joint: Joint, pair: tuple[Pulley, Pulley], layout: Layout) -> None:
    """Seats of both sprockets where the chain's rollers are at the start.

    Raises UserError where pulleys overlap.
    """
    places = [layout.seen(pulley.body, (pulley.x, pulley.y), "ground")[0] for pulley in pair]
    first, second = pair
    way = places[1] - places[0]
    path = BeltPath(first.radius, second.radius, math.hypot(*way), bool(joint.params["crossed"]))
    if not path.has_room or path.distance < first.lip + second.lip:
        scale = layout.sizes.scale
        radii = " and ".join(f"{pulley.radius * scale:.4g}" for pulley in pair)
        raise UserError(
            f"{m.name}: belt '{joint.name}': its pulleys of {radii} mm overlap, because their centres are "
            f"{path.distance * scale:.4g} mm apart; move a centre or make one smaller, or write "
            f"{shown_file(m.name, 'parts')}"
        )
    if not first.teeth:
        return
    turns = [layout.poses[pulley.body][0][2] for pulley in pair]
    line, pitch = math.atan2(way[1], way[0]), 2 * math.pi * first.radius / first.teeth
    spacing = path.length / max(round(path.length / pitch), 1)
    first.phase = 0.0
    seat = first.radius * (turns[0] - line - path.beta)
    there = seat + spacing * math.ceil((path.parts[0] + path.parts[1] - seat) / spacing)
    second.phase = path.on_second(there) + line - turns[1]
