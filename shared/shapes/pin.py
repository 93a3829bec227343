"""Turned parts on a joint's axis: pins, washers, circlips, flanged bushings, a stylus."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cadquery as cq

from shared.shapes.build import built_once, extruded, turned
from shared.shapes.outline import circle
from shared.shapes.solid import Solid, placed
from shared.shapes.standards import Fit

THINNED = 0.3
"""Part of a wall's thickness that a chamfer takes from each side at most."""


@dataclass(frozen=True)
class Head:
    """The head of a pin (mm): a cylinder with a dome on it and a centre mark in its middle."""

    diameter: float
    height: float
    dome: float = 1.2
    """Height of the domed part, out of ``height``."""


@dataclass(frozen=True)
class Groove:
    """Groove for a circlip (mm): z to z + width above the pin's lower end, ``depth`` into the radius."""

    z: float
    width: float
    depth: float


@built_once
def pin(
    diameter: float, length: float, head: Head | None = None, groove: Groove | None = None, chamfer: float = 0.6
) -> cq.Workplane:
    """Return a pin on the z axis from z = 0 to z = length, its head on top. No through hole."""
    r, c = diameter / 2, chamfer
    profile: list[tuple[float, ...]] = [(0, 0), (r - c, 0), (r, c)]
    if groove:
        inner = r - groove.depth
        profile += [(r, groove.z), (inner, groove.z), (inner, groove.z + groove.width), (r, groove.z + groove.width)]
    if head is None:
        profile += [(r, length - c), (r - c, length), *_centre_mark(length, r)]
        return turned(profile)
    top, edge = length + head.height, head.diameter / 2
    rim = edge * 0.55
    dome = min(head.dome, edge - rim)
    shoulder, arch = top - dome, ((edge - rim) ** 2 + dome**2) / (2 * dome)  # level where it meets the flat top
    half = math.asin(min((edge - rim) / arch, 1.0)) / 2
    middle = (rim + arch * math.sin(half), top - arch * (1 - math.cos(half)))
    profile += [(r, length), (edge - 0.3, length), (edge, length + 0.3), (edge, shoulder)]
    profile += [(*middle, rim, top), *_centre_mark(top, r)]
    return turned(profile)


@built_once
def washer(inner: float, outer: float, thickness: float, chamfer: float = 0.15) -> cq.Workplane:
    """Return a flat washer (diameters in mm) from z = 0 up, with one through hole.

    A thin wall gets a smaller chamfer.

    Raises ValueError where the hole leaves no wall.
    """
    a, b, t = inner / 2, outer / 2, thickness
    c = min(chamfer, _largest_chamfer(a, b))
    return turned([(a, 0), (b - c, 0), (b, c), (b, t - c), (b - c, t), (a, t)])


def _largest_chamfer(inner: float, outer: float) -> float:
    """Return the largest chamfer (mm) of both edges of a wall between two radii.

    Raises ValueError without a wall.
    """
    if outer <= inner:
        raise ValueError(f"a hole of {2 * inner:.4g} mm leaves no wall of a ring of {2 * outer:.4g} mm")
    return THINNED * (outer - inner)


def grooved(ring: cq.Workplane, count: int, reach: float, width: float, depth: float) -> cq.Workplane:
    """Return a ring about z with ``count`` straight grooves in its upper face.

    They go from the middle out to ``reach`` (mm).
    """
    box = ring.val().BoundingBox()
    for k in range(count):
        tool = cq.Workplane().box(reach, width, 2 * depth).translate((reach / 2, 0, box.zmax))
        ring = ring.cut(tool.rotate((0, 0, 0), (0, 0, 1), 360.0 * k / count))
    return ring


@built_once
def bushing(inner: float, outer: float, flange: float, flange_thickness: float, length: float) -> cq.Workplane:
    """Return a flanged bushing (diameters in mm) with one through hole.

    Its flange goes from z = 0 up, its barrel down to z = -length.

    A thin wall gets smaller chamfers. Raises ValueError where the hole leaves no wall.
    """
    a, b, f, t = inner / 2, outer / 2, flange / 2, flange_thickness
    c = min(0.25, _largest_chamfer(a, b))
    return turned(
        [
            (a, -length + c),
            (a + c, -length),
            (b - c, -length),
            (b, -length + c),
            (b, 0),
            (f - c, 0),
            (f, c),
            (f, t - c),
            (f - c, t),
            (a + c, t),
            (a, t - c),
        ]
    )


@built_once
def circlip(inner: float, thickness: float, band: float = 0.0) -> cq.Workplane:
    """Return an external circlip round a groove of diameter ``inner`` (mm), z = 0 up, its gap at +x.

    The band is widest opposite the gap and ends in two ears with a hole each: two through holes.
    """
    band = band or 0.16 * inner + 0.6
    r = inner / 2
    ear, eye, lean = 0.95 * band, 0.5 * band, 0.25 * band
    turn = math.asin((ear + 0.25 * band) / (r + ear))
    ring = extruded(circle(-lean, 0, r + band), thickness)
    ears = [((r + ear * 1.05) * math.cos(a), (r + ear * 1.05) * math.sin(a)) for a in (turn, -turn)]
    for x, y in ears:
        ring = ring.union(extruded(circle(x, y, ear), thickness))
    gap = cq.Workplane().box(4 * r, 0.5 * band, 3 * thickness, centered=(False, True, True))
    ring = ring.cut(extruded(circle(0, 0, r), 3 * thickness, -thickness)).cut(gap)
    for x, y in ears:
        ring = ring.cut(extruded(circle(x, y, eye), 3 * thickness, -thickness))
    return ring


def stylus(diameter: float, length: float, height: float, ball: float) -> cq.Workplane:
    """Return a tracer: a shank from z = -length to 0, a collar, and a cone up to a ball tip.

    The tip ends at z = height.
    """
    r, collar, c = diameter / 2, diameter * 0.85, 0.3
    centre = height - ball
    meet = (ball * math.cos(0.4), centre - ball * math.sin(0.4))
    return turned(
        [
            (0, -length),
            (r - c, -length),
            (r, -length + c),
            (r, 0),
            (collar - 0.2, 0),
            (collar, 0.2),
            (collar, 1.0),
            (collar - 0.2, 1.2),
            (r, 1.2),
            meet,
            (ball * math.cos(0.5), centre + ball * math.sin(0.5), 0.1 * ball, height - 0.005 * ball),
            (0, height - 0.005 * ball),
        ]
    )


def _centre_mark(top: float, radius: float) -> list[tuple[float, float]]:
    """Return the cone that a centre drill leaves in a turned face.

    Its floor is flat, since a mesh may tear at an apex.
    """
    depth = 0.2 * radius
    return [(0.3 * radius, top), (0.06 * radius, top - depth), (0, top - depth)]


# Hardware of a revolute joint, so that every mechanism's joints look and fit alike (mm).
#
# A link turns on the pin in two flanged bushings, one pressed in from each face. Above and below it run washers that
# belong to the pin's body; a circlip or the pin's head keeps them on.


@dataclass(frozen=True)
class Pivot:
    """Sizes of one joint's hardware: diameters and thicknesses in mm.

    Washer and circlip are those of a pin of 8 mm after DIN 988 and DIN 471.
    """

    pin: float = 8.0
    bushing: float = 11.0
    flange: float = 17.6
    flange_thickness: float = 1.2
    washer: float = 14.0
    washer_thickness: float = 1.0
    clip_thickness: float = 0.8
    groove_depth: float = 0.2
    groove_width: float = 0.9
    fit: Fit = Fit()
    washer_buy: str = ""
    """Names of a washer and of a circlip in shops; empty if no standard has these sizes."""
    clip_buy: str = ""

    @property
    def held(self) -> float:
        """Bore of the part that holds the pin."""
        return self.pin + self.fit.press

    @property
    def running(self) -> float:
        """Bore of the link that takes the bushings."""
        return self.bushing + self.fit.press

    @property
    def flange_room(self) -> float:
        """Height from a link's face to the far side of a bushing's flange."""
        return self.fit.seat + self.flange_thickness

    @property
    def washer_room(self) -> float:
        """Height that a washer takes with its seat."""
        return self.fit.seat + self.washer_thickness

    @property
    def retainer_room(self) -> float:
        """Height from the running flange to the far side of the circlip."""
        return self.fit.axial + self.washer_thickness + self.fit.seat + self.clip_thickness

    def bored(self, play: float = 0.0) -> float:
        """Return the bore of a bushing in which the pin's axis may be ``play`` away from the middle."""
        return self.pin + self.fit.running + 2 * play

    def bushings(self, joint: str, x: float, y: float, z: float, thickness: float, play: float = 0.0) -> list[Solid]:
        """Return the two bushings of a link between z and z + thickness, its eye flush there.

        See :meth:`bored`.
        """
        fit, length = self.fit, thickness / 2 - 0.1
        inner = self.bored(play)
        shape = bushing(inner, self.bushing, self.flange, self.flange_thickness, length)
        below = placed(shape.rotate((0, 0, 0), (1, 0, 0), 180), x, y, z - fit.seat)
        above = placed(shape, x, y, z + thickness + fit.seat)
        return [Solid(f"bushing_{joint}_low", below, "bronze", 1), Solid(f"bushing_{joint}_high", above, "bronze", 1)]

    def washer_at(self, name: str, x: float, y: float, z: float, material: str = "steel") -> Solid:
        """Return a washer from z up, on the pin at (x, y)."""
        shape = washer(self.pin + self.fit.running, self.washer, self.washer_thickness)
        return Solid(name, placed(shape, x, y, z), material, 1, buy=self.washer_buy)

    def groove(self, z: float) -> Groove:
        """Return the groove of a circlip that sits from z up (measured from the pin's lower end)."""
        return Groove(z - (self.groove_width - self.clip_thickness) / 2, self.groove_width, self.groove_depth)

    def clip_at(self, name: str, x: float, y: float, z: float, turn: float = 0.0) -> Solid:
        """Return a circlip from z up, its gap at ``turn`` degrees."""
        shape = circlip(self.pin - 2 * self.groove_depth + 2 * self.fit.seat, self.clip_thickness)
        return Solid(name, placed(shape, x, y, z, turn), "steel", 2, buy=self.clip_buy)
