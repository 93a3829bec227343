"""Hardware of a revolute joint, so that every mechanism's joints look and fit alike (mm).

A link turns on the pin in two flanged bushings, one pressed in from each face. Above and below it run washers that
belong to the pin's body; a circlip or the pin's head keeps them on.
"""

from __future__ import annotations

from dataclasses import dataclass

from shared.shapes.fit import Fit
from shared.shapes.pin import Groove, bushing, circlip, washer
from shared.shapes.solid import Solid, placed


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
        return [
            Solid(f"bushing_{joint}_low", below, "bronze", 1),
            Solid(f"bushing_{joint}_high", above, "bronze", 1),
        ]

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
