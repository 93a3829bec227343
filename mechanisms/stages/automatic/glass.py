"""Glass plates: bodies without an order of layers, or without a sound solid, are shown as panes that may overlap."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import cadquery as cq
import numpy as np

from mbsd import Mechanism, Solution
from mechanisms.stages.automatic import assembly
from mechanisms.stages.automatic.features import SHAPELESS
from mechanisms.stages.automatic.layout.layout import Layout
from mechanisms.stages.automatic.layout.motion import poses_of, times_of
from mechanisms.stages.automatic.layout.plan import free_name
from mechanisms.stages.automatic.layout.planar import Rounded, around, convex_hull
from mechanisms.stages.automatic.layout.sizes import EXTENTS, ROD, Sizes, stretching
from mechanisms.stages.automatic.pins.pins import add_poses, pins_of, places
from mechanisms.stages.automatic.standing import BackPlate, Upright, hold
from shared.contract import Mount
from shared.shapes import outline
from shared.shapes.base import base_plate
from shared.shapes.bodies import Bodies
from shared.shapes.build import extruded, turned
from shared.shapes.facets import facets
from shared.shapes.outline import circle
from shared.shapes.solid import Solid, placed

# The panes of bodies: the hull of what is on each, thin, bored for its pins (rmm).

THICK, GAP = 3.0, 1.0
"""Thickness of a pane, and the gap from one to the next."""
EYE = 10.0
"""Radius of a pane's corners."""
PIN, LOOSE = 2.6, 0.5
"""Radius of a pin, and how much wider its hole is."""
CAP, CAP_HEIGHT = 5.5, 1.4
RAIL, RAIL_HEIGHT = 4.0, 2.0
"""Half of the width of a rail on ground, and its height."""
RIM = 24
"""Points on the rim of a disc from which a hull is taken."""
BASE = "pla_white"
"""Material of the base plate: glass shows before what is light."""
MARGIN = 34.0
"""Margin of the base plate beyond what stands on it."""


@dataclass
class Pane:
    """The plate of one body: places that it reaches, and discs about some of them (rmm)."""

    places: list[tuple[float, float]] = field(default_factory=list)
    discs: list[tuple[float, float, float]] = field(default_factory=list)

    @property
    def shape(self) -> Rounded:
        """Hull in the plane."""
        turn = 2 * np.pi * np.arange(RIM) / RIM
        rims = [(x + (r - EYE) * c, y + (r - EYE) * s) for x, y, r in self.discs if r > EYE
                for c, s in zip(np.cos(turn), np.sin(turn), strict=True)]  # fmt: skip
        return around([*self.places, *((x, y) for x, y, _ in self.discs), *rims], EYE)

    def solid(self, holes: Sequence[tuple[float, float]]) -> tuple[cq.Workplane, int]:
        """Return the plate from z = 0 up, and its number of through holes."""
        corners = [(float(x), float(y), EYE) for x, y in convex_hull(np.array(self.places or [self.discs[0][:2]]))]
        shape = extruded(circle(*corners[0]) if len(corners) == 1 else outline.hull(corners), THICK)
        for x, y, radius in self.discs:
            if radius > EYE:
                shape = shape.union(extruded(circle(x, y, radius), THICK))
        bored: list[tuple[float, float]] = []
        for place in holes:
            if all(math.dist(place, other) > 2 * (PIN + LOOSE) + 0.5 for other in bored):
                bored.append(place)
                shape = shape.cut(placed(extruded(circle(0, 0, PIN + LOOSE), 3 * THICK, -THICK), *place))
        return shape, len(bored)


def panes_of(layout: Layout, solution: Solution, bodies: Collection[str]) -> dict[str, Pane]:
    """Return the panes of ``bodies``, rods among them: all round what joints, forces and contacts have on each."""
    m, panes = layout.m, {body: Pane() for body in bodies}
    things = [joint for joint in m.joints.values() if joint.kind.name not in SHAPELESS]
    for thing in [*things, *m.contacts.values(), *stretching(m)]:
        for marker in (thing.i, thing.j):
            if marker.body.name in panes:
                panes[marker.body.name].places.append(layout.place(marker))
    for thing in (*m.joints.values(), *m.contacts.values(), *m.forces.values()):
        if thing.kind.name in EXTENTS:
            for marker, radius in EXTENTS[thing.kind.name](thing, solution).radii:
                if marker.body.name in panes:
                    panes[marker.body.name].discs.append((*layout.place(marker), layout.sizes.of_metres(radius)))
    for name, pane in panes.items():
        if name in layout.rods:
            pane.places += [(0.0, 0.0), (layout.sizes.of_metres(layout.rods[name].params["length"]), 0.0)]
            continue
        body = m.bodies[name]
        if body.length is not None:
            pane.places += [(0.0, 0.0), (layout.sizes.of_metres(body.length), 0.0)]
        if not pane.places and not pane.discs:
            pane.places.append((layout.sizes.of_metres(body.com[0]), layout.sizes.of_metres(body.com[1])))
    return panes


def levels_of(layout: Layout, panes: Mapping[str, Pane]) -> dict[str, int]:
    """Return a level for each pane, from 0 up: those that meet in the plane at some time have different ones.

    So panes never cut each other; only pins go through what passes between.
    """
    levels: dict[str, int] = {}
    shapes = {body: pane.shape for body, pane in panes.items()}
    for body, shape in shapes.items():
        taken = {level for other, level in levels.items() if _meet(layout, (body, shape), (other, shapes[other]))}
        levels[body] = next(level for level in range(len(panes)) if level not in taken)
    return levels


def _meet(layout: Layout, first: tuple[str, Rounded], second: tuple[str, Rounded]) -> bool:
    """Return True if two panes meet in the plane at some time."""
    ends = []
    for body, shape in (first, second):
        centre, radius = shape.reach
        pose = layout.poses[body]
        c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
        x, y = centre[0]
        ends.append((np.stack([pose[:, 0] + c * x - s * y, pose[:, 1] + s * x + c * y], axis=1), radius))
    (a, ra), (b, rb) = ends
    if float(np.linalg.norm(a - b, axis=1).min()) > ra + rb + layout.sizes.room:
        return False
    from mechanisms.stages.automatic.layout.planar import least_gap

    poses = layout.poses[first[0]], layout.poses[second[0]]
    return least_gap(first[1], second[1], poses, layout.sizes.room)[0] < layout.sizes.room


# Their solids, above what is built, or on a base plate of their own.


@dataclass(frozen=True)
class Panes:
    """Panes of ``bodies`` from ``bottom`` (rmm) up; ``spans`` gives the lower and upper face of other plates."""

    layout: Layout
    solution: Solution
    bodies: tuple[str, ...]
    bottom: float = THICK
    spans: Callable[[str], tuple[float, float]] | None = None

    def add(self, made: dict[str, list[Solid]]) -> None:
        """Add panes, pins and rails to the solids (mm)."""
        layout, taken = self.layout, {solid.name.lower() for solids in made.values() for solid in solids}
        panes = panes_of(layout, self.solution, self.bodies)
        levels, colours = levels_of(layout, panes), assembly.materials(layout.m)
        pins = [pin for pin in pins_of(layout) if panes.keys() & pin.places.keys()]
        scale, tolerance = layout.sizes.scale, layout.sizes.tolerance

        def enter(body: str, name: str, shape: cq.Workplane, material: str, holes: int) -> None:
            solid = assembly.scaled(Solid(free_name(name, taken), shape, material, holes, fitted=True), scale)
            made.setdefault(body, []).append(replace(solid, tolerance=tolerance))

        for body, pane in panes.items():
            shape, holes = pane.solid([pin.places[body] for pin in pins if body in pin.places])
            colour = colours.get(body, "aluminium").replace("aluminium", "acrylic")
            enter(body, body, placed(shape, z=self._low(levels[body])), colour, holes)
        for pin in pins:
            faces = [face for body in pin.places for face in self._faces(body, levels)]
            home = next((body for body in ("ground", *pin.places) if body in pin.places and body in made), None)
            if home and faces:
                low, high = min(faces), max(faces)
                shape = placed(_rivet(low, high, home == "ground"), *pin.places[home])
                enter(home, f"pin_{pin.name}", shape, "steel", 0)
        for name, shape in self._rails():
            enter("ground", f"rail_{name}", shape, "steel", 0)

    def _low(self, level: int) -> float:
        return self.bottom + level * (THICK + GAP)

    def _faces(self, body: str, levels: Mapping[str, int]) -> Sequence[float]:
        """Return the lower and upper face of a body's plate, of ground its face; nothing for bodies without solids."""
        if body == "ground":
            return (0.0,)
        if body in levels:
            return self._low(levels[body]), self._low(levels[body]) + THICK
        return self.spans(body) if self.spans and body not in self.layout.apart else ()

    def _rails(self) -> Iterator[tuple[str, cq.Workplane]]:
        """Yield strips on ground along which bodies slide."""
        for joint in self.layout.m.joints.values():
            moving = [marker for marker in (joint.i, joint.j) if marker.body.name in self.bodies]
            if joint.kind.name != "prismatic" or len(moving) != 1 or "ground" not in joint.bodies:
                continue
            way = self.layout.seen(moving[0].body.name, self.layout.place(moving[0]), "ground")
            far = way[np.argmax(np.linalg.norm(way - way[0], axis=1))]
            other = way[np.argmax(np.linalg.norm(way - far, axis=1))]
            if float(np.hypot(*(far - other))) > 0.1:
                ends = [(float(x), float(y), RAIL) for x, y in (far, other)]
                yield joint.name, extruded(outline.hull(ends), RAIL_HEIGHT)


def _rivet(low: float, high: float, on_ground: bool) -> cq.Workplane:
    """Return a pin through plates, with a cap above the highest, and below the lowest where it is not on ground."""
    foot = [(0.0, low), (PIN, low)] if on_ground else [(0.0, low - CAP_HEIGHT), (CAP, low - CAP_HEIGHT), (CAP, low - 0.1), (PIN, low - 0.1)]  # fmt: skip  # noqa: E501
    return turned([*foot, (PIN, high + 0.1), (CAP, high + 0.1), (CAP, high + CAP_HEIGHT), (0.0, high + CAP_HEIGHT)])


def plain_layout(m: Mechanism, sizes: Sizes, solution: Solution, left_out: Collection[str] = ()) -> Layout:
    """Return poses of bodies and rods alone, without features."""
    layout = Layout(m, sizes, poses_of(solution, sizes.of_metres(1.0)), times_of(solution))
    layout.apart = frozenset(left_out)
    add_poses(layout)
    return layout


def all_of_glass(layout: Layout, solution: Solution, mount: Mount) -> Bodies:
    """Return every body as a pane on a base plate."""
    bodies = tuple(layout.moving)
    made = Bodies()
    back = _back_plate(layout, mount)
    plate = base_plate(back.corners, assembly.PLATE, 12.0)
    upright, scale = Upright.from_mount(mount), layout.sizes.scale
    base = Solid("base_plate", upright.in_model(plate), BASE, 0, fitted=True)
    made["ground"] = [replace(assembly.scaled(base, scale), tolerance=layout.sizes.tolerance)]
    Panes(layout, solution, bodies).add(made)
    for rod, joint in layout.rods.items():
        made.join_places(rod, *places(joint))
    poses = {body: pose * [scale, scale, 1.0] for body, pose in layout.poses.items()}
    hold(made, mount, back.scaled(scale), poses, layout.sizes)
    for body in layout.apart.intersection(layout.m.bodies):
        made.leave_out(body)
    made.schematic = sentence_of(bodies, WISHED)
    return made


def _back_plate(layout: Layout, mount: Mount) -> BackPlate:
    """Return a plate round all that ground holds, or under what moves where it holds nothing (rmm)."""
    upright = Upright.from_mount(mount)
    held = [pin.places["ground"] for pin in pins_of(layout) if pin.on_ground]
    for joint in layout.m.joints.values():
        if "ground" in joint.bodies and joint.kind.name not in (*SHAPELESS, "revolute", ROD):
            held += layout.seen(joint.bodies[1] if joint.bodies[0] == "ground" else joint.bodies[0],
                                layout.place(joint.j if joint.i.body.name == "ground" else joint.i),
                                "ground").tolist()  # fmt: skip
    if not held:
        held = np.concatenate([layout.poses[body][:, :2] for body in layout.moving]).tolist()
    seen = upright.seen(np.array(held))
    (x0, y0), (x1, y1) = (seen.min(axis=0) - MARGIN).tolist(), (seen.max(axis=0) + MARGIN).tolist()
    return BackPlate((x0, y0, x1, y1), 0.0, assembly.PLATE, 1.0, layout.sizes.pivot.fit.seat)


# One pane in place of a solid that the CAD kernel cannot make closed.


def pane_for(solid: Solid) -> Solid:
    """Return a prism of clear glass on the hull of a solid (mm), as high as that is."""
    corners = np.concatenate([facets(own, 0.05, 0.3).reshape(-1, 3) for own in solid.shape.solids().vals()])
    hull = convex_hull(corners[:, :2].astype(float), 1e-6)
    low, high = float(corners[:, 2].min()), float(corners[:, 2].max())
    wire = cq.Wire.makePolygon([cq.Vector(float(x), float(y), 0.0) for x, y in hull], close=True)
    return replace(solid, shape=extruded(wire, high - low, low), material="acrylic", through_holes=0, buy="")


def sentence_of(bodies: Sequence[str], why: str = "{} cannot pass each other in layers") -> str:
    """Return the sentence that a picture has in its corner; ``why`` says {} where it names bodies."""
    named = bodies if len(bodies) <= NAMED else [*bodies[: NAMED - 1], f"{len(bodies) - NAMED + 1} more"]
    listed = f"{', '.join(named[:-1])} and {named[-1]}" if len(named) > 1 else "".join(named)
    return f"Glass plates that may overlap: {why.format(listed)}"


WISHED = "{} by the wish of parts.py"
"""Why bodies are of glass that an author shows so."""
NAMED = 4
"""So many bodies are named in a picture."""
