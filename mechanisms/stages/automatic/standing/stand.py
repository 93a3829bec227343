"""The stand of a machine, once all its solids are there: foot, column, screws and pads, and the holes in its plate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import cadquery as cq

from mechanisms.stages.automatic.standing.dimensions import Dimensions, dimensions, screw_places
from mechanisms.stages.automatic.standing.named import named
from mechanisms.stages.automatic.standing.standing_masses import standing
from shared.shapes.build import extruded
from shared.shapes.outline import circle
from shared.shapes.solid import Solid
from shared.shapes.stand import Bolt, bolt, column, drilled, foot, screwed, seated

if TYPE_CHECKING:
    import numpy as np

    from mechanisms.stages.automatic.standing.back_plate import BackPlate, Upright

SCREW = 5.0
"""Wished diameter of the screws (units)."""
INTO = 0.6
"""How far they go into a plate, as a part of its thickness."""
BEYOND = 0.8
"""Length of a blind hole beyond the end of its screw (units)."""
PAD = (7.0, 2.0)
"""Radius and height of the pads under a foot (units)."""
CORNER, EDGE = 9.0, 1.2
"""Radius of the corners of a foot, and of its rounded edges (units)."""
LINKAGE, ENGINE = ("beech", "aluminium"), ("cast_iron", "cast_iron")
"""What foot and column are made of."""


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
        """The solids of ground with the stand: its first, the back plate, has holes for screws now."""
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
        """A screw that goes through so much matter, its head below the face, and ``into`` what is behind."""
        longest = through - 1.1 * wish + seat + 0.85 * into
        return bolt(wish * self.ratio, longest * self.ratio).at_scale(1.0 / self.ratio)

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


def _size(span: tuple[float, float]) -> float:
    return span[1] - span[0]


def _below(own: Dimensions, below: Bolt) -> list[tuple[float, float, float]]:
    """Places, on the lower face of the foot, of screws that go up into the column."""
    half = max(own.widths[0] / 2 - 2.2 * below.seat, below.seat)
    z = sum(own.column[1]) / 2
    return [(own.middle + side * half, own.foot[1][0], z) for side in (-1.0, 1.0)]


def _screw(name: str, screw: Bolt, place: tuple[float, float, float], way: str) -> Solid:
    return Solid(name, screwed(screw, place, way), "steel", 0, buy=screw.buy)
