"""The stand and base plate of a mechanism: dimensions, masses that must not tip over, and solids (mm)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.layout.plan import free_name
from mechanisms.stages.automatic.layout.planar import convex_hull
from mechanisms.stages.automatic.layout.planar import placed as placed_points
from mechanisms.stages.automatic.layout.sizes import Sizes
from shared.contract import Mount
from shared.contract.materials import MATERIALS
from shared.shapes.bodies import Bodies
from shared.shapes.build import extruded
from shared.shapes.facets import facets
from shared.shapes.kernel import rough_size
from shared.shapes.outline import circle
from shared.shapes.solid import Solid, placed
from shared.shapes.stand import Bolt, bolt, column, drilled, foot, screwed, seated

# The base plate of a machine that stands, and the axes in which it is laid out: x right and y up as it stands.


@dataclass(frozen=True)
class Upright:
    """The turn from the axes of the model to right and up of a mount; of a desk it is none."""

    angle: float = 0.0
    """Angle of ``up`` from y, counter-clockwise (rad)."""

    @classmethod
    def from_mount(cls, mount: Mount) -> Upright:
        """Return the upright axes of a mount."""
        x, y, _ = mount.up
        return cls() if mount.kind == "desk" else cls(math.atan2(-x, y) + 0.0)

    def seen(self, places: np.ndarray) -> np.ndarray:
        """Return places (..., 2) of the model, as right and up."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return places if self.angle == 0.0 else places @ np.array([[c, -s], [s, c]])

    def seen_place(self, x: float, y: float) -> tuple[float, float]:
        """Return one place of the model, as right and up."""
        u, v = self.seen(np.array([x, y]))
        return float(u), float(v)

    def as_seen(self, shape: cq.Workplane) -> cq.Workplane:
        """Return a shape of the model in these axes."""
        return placed(shape, turn=-math.degrees(self.angle)) if self.angle else shape

    def in_model(self, shape: cq.Workplane) -> cq.Workplane:
        """Return a shape in these axes as the model has it."""
        return placed(shape, turn=math.degrees(self.angle)) if self.angle else shape


@dataclass(frozen=True)
class BackPlate:
    """A plate (mm, right and up of the mount) that carries what stands on ground.

    ``unit`` is the size of its millimetre of reference, to which thicknesses and screws go.
    """

    corners: tuple[float, float, float, float]
    top: float
    """z of its face."""
    thickness: float
    unit: float
    seat: float
    """Gap between pieces that are screwed together."""
    holes: tuple[tuple[float, float, float], ...] = ()
    """x, y and radius of blind holes in its face, which its screws keep clear of."""
    hull: tuple[tuple[float, float], ...] = ()
    """Counter-clockwise centres of the round corners of a plate that is no rectangle; of others none."""
    corner: float = 0.0
    """Radius of these corners."""

    def scaled(self, scale: float) -> BackPlate:
        """Return a copy with all lengths times ``scale``."""
        x0, y0, x1, y1 = (scale * value for value in self.corners)
        holes = tuple((scale * x, scale * y, scale * radius) for x, y, radius in self.holes)
        hull = tuple((scale * x, scale * y) for x, y in self.hull)
        top, thickness, unit, seat = (scale * length for length in (self.top, self.thickness, self.unit, self.seat))
        return BackPlate((x0, y0, x1, y1), top, thickness, unit, seat, holes, hull, scale * self.corner)

    def inside(self, x: float, y: float) -> float:
        """Return how far a place is from the rim; below 0 outside."""
        x0, y0, x1, y1 = self.corners
        border = self.hull or ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
        return self.corner + min(
            ((c - a) * (y - b) - (d - b) * (x - a)) / math.hypot(c - a, d - b)
            for (a, b), (c, d) in pairwise((*border, border[0]))
        )

    @property
    def width(self) -> float:
        """To the right."""
        return self.corners[2] - self.corners[0]

    @property
    def height(self) -> float:
        """Upwards."""
        return self.corners[3] - self.corners[1]

    @property
    def back(self) -> float:
        """z of its rear face."""
        return self.top - self.thickness


# How low the solids of a machine ever reach, and where their common centre of mass is (mm, kg), as it stands.

CHORD, ANGLE = 0.002, 0.4
"""Coarse meshes: largest distance from the surface, in edges, for each mm of the solid; largest angle (rad)."""


@dataclass(frozen=True)
class Hull:
    """Hull of one solid in its body's frame: corners (n, 2) in the plane, heights, mass and centre."""

    corners: np.ndarray
    heights: tuple[float, float]
    mass: float
    centre: np.ndarray

    @classmethod
    def from_solid(cls, solid: Solid, shape: cq.Workplane | None = None) -> Hull:
        """Return the hull of its ``shape`` or one that is turned, by a coarse mesh."""
        whole = (solid.shape if shape is None else shape).solids()
        faces = facets(whole.vals()[0], CHORD * rough_size(whole), ANGLE, relative=True).astype(float)
        places = faces.reshape(-1, 3)
        parts = np.einsum("ij,ij->i", faces[:, 0], np.cross(faces[:, 1], faces[:, 2])) / 6
        centre = (parts[:, None] * faces.sum(axis=1)).sum(axis=0) / 4 / parts.sum()
        mass = MATERIALS[solid.material].density * 1e-9 * float(parts.sum())
        heights = float(places[:, 2].min()), float(places[:, 2].max())
        return cls(convex_hull(places[:, :2]), heights, mass, centre)


@dataclass(frozen=True)
class Standing:
    """All that a stand has to carry, over the motion."""

    low: np.ndarray
    """(3,) of the box round what is on ground and what moves: right, up, towards the viewer."""
    high: np.ndarray
    moving: float
    """How low anything that moves reaches; infinite where nothing does."""
    centres: np.ndarray
    """(T, 3) of the common centre of mass."""


def standing(bodies: Mapping[str, Sequence[Solid]], poses: Mapping[str, np.ndarray], upright: Upright) -> Standing:
    """Return the masses that stand, over the ``poses`` (T, 3) (mm, rad) of the bodies.

    A body without poses is left out.
    """
    still = np.zeros((1, 3))
    lows, highs, moving = [], [], np.inf
    mass, moment = 0.0, np.zeros((1, 3))
    for body, solids in bodies.items():
        if body != "ground" and body not in poses:
            continue
        hulls = [Hull.from_solid(solid, upright.as_seen(solid.shape) if body == "ground" else None) for solid in solids]
        for own in hulls:
            path, turn = (still, None) if body == "ground" else (poses[body], upright)
            corners = np.array([_seen(corner, path, turn) for corner in own.corners])
            low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
            lows.append([*low, own.heights[0]])
            highs.append([*high, own.heights[1]])
            moving = moving if body == "ground" else min(moving, float(low[1]))
            there = _seen(own.centre[:2], path, turn)
            moment = moment + own.mass * np.column_stack([there, np.full(len(there), own.centre[2])])
            mass += own.mass
    return Standing(np.min(lows, axis=0), np.max(highs, axis=0), moving, moment / mass)


def _seen(place: np.ndarray, poses: np.ndarray, upright: Upright | None) -> np.ndarray:
    """Return (T, 2) a place of a body's frame over its poses (T, 3), as right and up.

    Without a turn as it is.
    """
    way = placed_points(place[None], poses)[:, 0]
    return way if upright is None else upright.seen(way)


def named(made: Sequence[Solid], bodies: Mapping[str, Sequence[Solid]]) -> list[Solid]:
    """Return solids with names that are numbered where ``bodies`` have them already."""
    taken = {solid.name.lower() for solids in bodies.values() for solid in solids}
    return [replace(solid, name=free_name(solid.name, taken)) for solid in made]


# How large a stand is: below all that moves, no larger than it needs, and so wide that it does not tip (mm).

type Span = tuple[float, float]
TIPS = math.tan(math.radians(10.0))
"""A stand that is tilted by less than this, to any side, stands up again."""
CLEAR, CLEARANCE = 6.0, 0.02
"""Least gap under what moves: in units, and as a part of the height over the foot."""
FOOT, FOOT_HEIGHT = 9.0, 0.04
"""Least height of a foot: in units, and as a part of the larger side of what it carries."""
WIDE = 0.3
"""Half the width of a foot that a plate asks for by its looks, as a part of its own."""
AROUND = 14.0
"""Margin of the foot round what stands on it (units)."""
EVEN = 0.3
"""Sides of a foot that differ by less are made equal."""
COLUMN = (0.34, 26.0, 0.8, 0.10)
"""Width of a column, as a part of the plate's: wished, at least (units), at most; and what it grows by to its lower
end, as a part of its free length.
"""
COLUMN_THICK = (10.0, 0.045)
"""Thickness of a column, at least (units), and as a part of its length."""
OVERLAP = 0.66
"""Part of a plate's height to which a column is screwed."""
SCREWS_OF_FOOT = 1.5
"""Height that they take in the lower end of a column, in thicknesses of the plate."""


@dataclass(frozen=True)
class Dimensions:
    """Right, up and towards the viewer; the column stands on the foot and is behind the plate."""

    foot: tuple[Span, Span, Span]
    column: tuple[Span, Span]
    """Up, and towards the viewer."""
    middle: float
    """Middle of the column, right."""
    widths: Span
    """Widths of the column at its lower and upper end."""


def dimensions(plate: BackPlate, load: Standing) -> Dimensions:
    """Return dimensions of the stand of a plate and all that it carries."""
    unit, x0, y0, x1, y1 = plate.unit, *plate.corners
    top = max(float(load.high[1]), y1)
    clear = max(CLEAR * unit, CLEARANCE * (top - min(load.moving, y0)))
    others = float(load.low[1]) - (plate.seat if load.moving > load.low[1] else clear)
    over = min(y0 - plate.seat, load.moving - clear, others)
    low, high = over + plate.seat, y0 + OVERLAP * plate.height
    thick = max(COLUMN_THICK[0] * unit, COLUMN_THICK[1] * (high - low))
    part, least, most, grows = COLUMN
    upper = min(max(part * plate.width, least * unit), most * plate.width)
    lower = upper + grows * (y0 - low)
    middle, rear = (x0 + x1) / 2, plate.back - plate.seat - thick
    deep = max(FOOT * unit, FOOT_HEIGHT * max(top - over, plate.width))
    around = AROUND * unit
    right, _, near = foot_spans(load, over - deep)
    half = max(lower / 2 + around, WIDE * plate.width)
    across = evened(min(right[0], middle - half), max(right[1], middle + half), middle)
    along = min(near[0], rear - 0.7 * around), max(near[1], plate.top + around)
    foot = across, (over - deep, over), along
    return Dimensions(foot, ((low, high), (rear, rear + thick)), middle, (lower, upper))


def foot_spans(load: Standing, ground: float) -> tuple[Span, Span, Span]:
    """Return how far a foot must reach on ``ground`` not to tip: right, up, towards the viewer."""
    reach = TIPS * (load.centres[:, 1] - ground)
    spans = [(float((load.centres[:, k] - reach).min()), float((load.centres[:, k] + reach).max())) for k in range(3)]
    return spans[0], spans[1], spans[2]


def evened(low: float, high: float, middle: float) -> Span:
    """Return ``low`` and ``high``, made symmetrical about ``middle`` where it nearly is."""
    left, right = middle - low, high - middle
    if abs(left - right) < EVEN * max(left, right):
        left = right = max(left, right)
    return middle - left, middle + right


def screw_places(plate: BackPlate, own: Dimensions, clear: float) -> list[tuple[float, float]]:
    """Return where screws of a column go into the plate, near the corners of what they share.

    They stay ``clear`` (radius) of all holes of its face.
    """
    (x0, x1), (y0, y1) = _shared(plate, own, 2.2 * clear)
    grid = [(x, y) for x in np.linspace(x0, x1, 9) for y in np.linspace(y0, y1, 13)]
    free = [
        (float(x), float(y))
        for x, y in grid
        if plate.inside(x, y) > 1.3 * clear
        and all(math.hypot(x - u, y - v) > radius + 1.3 * clear for u, v, radius in plate.holes)
    ]
    chosen: list[tuple[float, float]] = []
    for corner in ((x0, y0), (x1, y1), (x1, y0), (x0, y1)):
        beside = [place for place in free if all(math.dist(place, other) > 4.5 * clear for other in chosen)]
        if beside:
            chosen.append(min(beside, key=lambda place: (round(math.dist(place, corner), 6), place)))
    return chosen


def _shared(plate: BackPlate, own: Dimensions, inset: float) -> tuple[Span, Span]:
    """Return right and up of what plate and column share, without its rim."""
    half = own.widths[1] / 2 - inset
    low = max(plate.corners[1], own.column[0][0] + SCREWS_OF_FOOT * plate.thickness) + inset
    high = own.column[0][1] - inset
    if high < low:
        low = high = (low + high) / 2
    return (own.middle - max(half, 0.0), own.middle + max(half, 0.0)), (low, high)


# The stand of a machine, once all its solids are there: foot, column, screws and pads, and the holes in its plate.

SCREW = 5.0
"""Wished diameter of the screws (units)."""
INTO = 0.6
"""How far they go into a plate, as a part of its thickness."""
LEAST_INTO = 0.4
"""Part of that which a screw of a standard length may go in: of a machine of 4 m none is long enough."""
BEYOND = 0.8
"""Length of a blind hole beyond the end of its screw (units)."""
PAD = (7.0, 2.0)
"""Radius and height of the pads under a foot (units)."""
CORNER, EDGE = 9.0, 1.2
"""Radius of the corners of a foot, and of its rounded edges (units)."""
LINKAGE, ENGINE = ("beech", "aluminium"), ("cast_iron", "cast_iron")
"""Material of foot and column."""


@dataclass(frozen=True)
class Stand:
    """Stand of a back plate; ``poses`` (T, 3) (mm, rad) say how bodies move."""

    plate: BackPlate
    upright: Upright
    poses: Mapping[str, np.ndarray]
    materials: tuple[str, str] = LINKAGE
    """Materials of foot and column."""
    tolerance: float | None = None
    ratio: float = 1.0
    """Millimetres of the finished piece for one here."""

    def __call__(self, bodies: Mapping[str, Sequence[Solid]]) -> list[Solid]:
        """Return the solids of ground with the stand: its first, the back plate, has holes for screws now."""
        load = standing(bodies, self.poses, self.upright)
        own, plate = dimensions(self.plate, load), self.plate
        thick, deep, into = _size(own.column[1]), _size(own.foot[1]), INTO * plate.thickness
        behind = self._bolt(SCREW * plate.unit, thick, into, plate.seat)
        places = [(x, y, own.column[1][0]) for x, y in screw_places(plate, own, behind.seat)]
        below = self._bolt(min(SCREW * plate.unit, 0.45 * thick), deep, 2 * into, plate.seat)
        feet = _below(own, below)
        main, *others = bodies["ground"]
        tapped = [(x, y, plate.back) for x, y, _ in places]
        depth = behind.length - (thick - behind.sunk) + BEYOND * plate.unit
        held = drilled(self.upright.as_seen(main.shape), tapped, "z", behind.bore, depth)
        made = [
            Solid("stand_column", self._column(own, places, behind, feet, below), self.materials[1], len(places)),
            Solid("stand_foot", self._foot(own, feet, below), self.materials[0], len(feet)),
        ]
        for k, (x, y, z) in enumerate(places, start=1):
            made.append(_screw(f"stand_screw_{k}", behind, (x, y, z + behind.sunk - plate.seat / 2), "z"))
        for k, (x, y, z) in enumerate(feet, start=1):
            made.append(_screw(f"foot_screw_{k}", below, (x, y + below.sunk - plate.seat / 2, z), "y"))
        made += self._pads(own)
        turned = [
            replace(solid, shape=self.upright.in_model(solid.shape), tolerance=self.tolerance, fitted=True)
            for solid in made
        ]
        return [replace(main, shape=self.upright.in_model(held)), *others, *named(turned, bodies)]

    def _column(
        self,
        own: Dimensions,
        places: Sequence[tuple[float, float, float]],
        behind: Bolt,
        feet: Sequence[tuple[float, float, float]],
        below: Bolt,
    ) -> cq.Workplane:
        unit, (y, z) = self.plate.unit, own.column
        corners = 1.6 * unit, min(0.3 * own.widths[1], 14.0 * unit)
        shape = column(own.middle, y, z, own.widths, corners, 0.8 * unit)
        shape = seated(shape, places, "z", _size(z), behind)
        depth = below.length - (_size(own.foot[1]) - below.sunk) + BEYOND * unit
        return drilled(shape, [(x, y[0], at) for x, _, at in feet], "y", below.bore, depth)

    def _foot(self, own: Dimensions, feet: Sequence[tuple[float, float, float]], below: Bolt) -> cq.Workplane:
        unit, (x, y, z) = self.plate.unit, own.foot
        corner = min(CORNER * unit, 0.3 * (x[1] - x[0]), 0.3 * (z[1] - z[0]))
        shape = foot(x, y, z, corner, min(EDGE * unit, 0.2 * (y[1] - y[0])))
        return seated(shape, feet, "y", _size(y), below)

    def _bolt(self, wish: float, through: float, into: float, seat: float) -> Bolt:
        """Return a screw through so much matter and ``into`` what is behind, its head below the face."""
        shortest = through - 1.1 * wish + seat + LEAST_INTO * into
        longest = through - 1.1 * wish + seat + 0.85 * into
        return bolt(wish * self.ratio, shortest * self.ratio, longest * self.ratio).at_scale(1.0 / self.ratio)

    def _pads(self, own: Dimensions) -> list[Solid]:
        unit, (x, y, z) = self.plate.unit, own.foot
        radius = min(PAD[0] * unit, 0.2 * (x[1] - x[0]), 0.2 * (z[1] - z[0]))
        pad = extruded(circle(0, 0, radius), PAD[1] * unit).rotate((0, 0, 0), (1, 0, 0), 90)
        places = [
            (u, w)
            for u in (x[0] + 1.5 * radius, x[1] - 1.5 * radius)
            for w in (z[0] + 1.5 * radius, z[1] - 1.5 * radius)
        ]
        return [
            Solid(f"stand_pad_{k}", pad.translate((u, y[0] - self.plate.seat, w)), "rubber", 0)
            for k, (u, w) in enumerate(places, start=1)
        ]


APART = 1.1
"""Least distance of a screw of a narrow foot from its middle, in seats: two that only touched would share an edge."""


def _size(span: tuple[float, float]) -> float:
    return span[1] - span[0]


def _below(own: Dimensions, below: Bolt) -> list[tuple[float, float, float]]:
    """Return places, on the lower face of the foot, of screws that go up into the column."""
    half = max(own.widths[0] / 2 - 2.2 * below.seat, APART * below.seat)
    z = sum(own.column[1]) / 2
    return [(own.middle + side * half, own.foot[1][0], z) for side in (-1.0, 1.0)]


def _screw(name: str, screw: Bolt, place: tuple[float, float, float], way: str) -> Solid:
    return Solid(name, screwed(screw, place, way), "steel", 0, buy=screw.buy)


# The ground under a road that needs no back plate: a slab as long as the road, and so deep that nothing tips (mm).

SLAB = "concrete"
"""Its material."""


@dataclass(frozen=True)
class GroundSlab:
    """Under all that is on ground; ``poses`` (T, 3) (mm, rad) say how bodies move."""

    upright: Upright
    poses: Mapping[str, np.ndarray]
    unit: float
    seat: float
    tolerance: float | None = None

    def __call__(self, bodies: Mapping[str, Sequence[Solid]]) -> list[Solid]:
        """Return the solids of ground with the slab, on which its lowest one lies."""
        load = standing(bodies, self.poses, self.upright)
        fixed = standing({"ground": bodies["ground"]}, {}, self.upright)
        over = min(fixed.low[1] - self.seat, load.moving - CLEAR * self.unit)
        deep = max(FOOT * self.unit, FOOT_HEIGHT * float(fixed.high[0] - fixed.low[0]))
        right, _, near = foot_spans(load, over - deep)
        around = AROUND * self.unit
        x = min(right[0], fixed.low[0] - around), max(right[1], fixed.high[0] + around)
        z = min(near[0], fixed.low[2] - around), max(near[1], fixed.high[2] + around)
        slab = foot(x, (over - deep, over), z, min(9.0 * self.unit, 0.3 * (z[1] - z[0])), 1.2 * self.unit)
        made = Solid("ground_slab", self.upright.in_model(slab), SLAB, 0, tolerance=self.tolerance, fitted=True)
        return [*bodies["ground"], *named([made], bodies)]


# The stand of a machine, by its mount.


def hold(made: Bodies, mount: Mount, plate: BackPlate | None, poses: Mapping[str, np.ndarray], sizes: Sizes) -> None:
    """Note how parts stand, and what makes their stand.

    That is the stand of their back ``plate`` (mm), or of ground without one, over ``poses`` (T, 3) (mm, rad); nothing
    where they lie or hang at a wall.
    """
    made.mount, upright = (mount.kind, mount.up), Upright.from_mount(mount)
    if mount.kind not in ("stand", "ground"):
        return
    if plate is None:
        seat = sizes.pivot.fit.seat * sizes.scale
        made.stand = GroundSlab(upright, poses, sizes.scale, seat, sizes.tolerance)
    else:
        look = ENGINE if made.along else LINKAGE
        made.stand = Stand(plate, upright, poses, look, sizes.tolerance, sizes.ratio)
