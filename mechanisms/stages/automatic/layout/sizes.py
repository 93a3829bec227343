"""Sizes follow the mechanism: one scale for pins, eyes and plates, from its shortest link and its overall size.

Everything is laid out and built with pins of :data:`PIN` mm, in reference millimetres (rmm), and scaled at the end.
So a 20 mm clockwork and a 3 m excavator have the same proportions, chamfers included.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from mechanisms.stages.parts_files import TOLERANCE
from shared.shapes.fit import Fit
from shared.shapes.pin import Head
from shared.shapes.pivot import Pivot
from shared.shapes.screw import SOCKET
from shared.shapes.standards import CIRCLIPS, shim_ring
from shared.shapes.units import mm
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.extents import Lengths

PIN = 8.0
"""Diameter of a pin (rmm)."""
STANDARD = (
    0.5,
    0.6,
    0.8,
    1,
    1.2,
    1.6,
    2,
    2.5,
    3,
    4,
    5,
    6,
    8,
    10,
    12,
    16,
    20,
    25,
    30,
    40,
    50,
    60,
    80,
    100,
    120,
    160,
    200,
)
"""Diameters of pins that there are (mm), after ISO 2338; a larger one is a whole number of 50 mm."""
THICKEST_SCREW = 4.0
"""Largest screw of a pedestal's flange (rmm)."""
LEAST_LINK = 2.75
"""The shortest distance of two pins of one body, in diameters of a pin."""
OVERALL = 20.0
"""The longer side of what the joints sweep, in diameters of a pin."""

MUCH_THINNER = 2.5
"""Pins thinner by this factor than the size of the machine suggests are reported."""
COARSEST = 0.13
"""Tolerance of meshes, at most so much of the clearance of pins."""
THINNEST = 0.5
"""Thinnest of the pins that are tried, in pins of the wished size."""
CLEAR = 0.6
"""Between what touches by design, such as a cam and its roller, or stops, in running fits."""


@dataclass(frozen=True)
class Sizes:
    """Sizes in rmm; ``scale`` millimetres are one rmm."""

    scale: float
    pivot: Pivot
    thickness: float = 7.0
    """Thickness of links and plates."""
    eye: float = 13.0
    """Outer radius of an eye."""
    stylus_eye: float = 7.0
    hardware: float = 9.2
    """Radius of all that turns about a pin: flange, washer, head, boss, pedestal."""
    roller: float = 13.0
    """Diameter of a roller in a slot."""
    head: Head = Head(14.0, 4.0, 1.6)
    pedestal: float = 8.0
    """Least height of a pedestal."""
    pin_end: float = 1.2
    """What a pin shows beyond its circlip."""
    room: float = 1.5
    """Least gap in the plane between bodies that share a height."""
    ratio: float = 1.0
    """Millimetres of the finished piece for a millimetre here: 0.05 for a model at 1:20."""

    def of_metres(self, length: float) -> float:
        """A length of the model (m) in rmm."""
        return mm(length) / self.scale

    @property
    def finished(self) -> float:
        """Millimetres of the finished piece that one rmm is, which is what standards go by."""
        return self.scale * self.ratio

    @property
    def pin(self) -> float:
        """Diameter of a pin (mm)."""
        return PIN * self.scale

    @property
    def finished_pin(self) -> float:
        """The same of the finished piece."""
        return PIN * self.finished

    @property
    def end_room(self) -> float:
        """Height (rmm) that the head of a pin takes above the eye that turns under it, with room above."""
        pivot = self.pivot
        return pivot.flange_room + pivot.fit.axial + self.head.height + pivot.fit.axial

    @property
    def clip_room(self) -> float:
        """Height (rmm) that a circlip and the pin's end take above the eye, with room above."""
        return self.pivot.flange_room + self.pivot.retainer_room + self.pin_end + self.pivot.fit.axial

    @property
    def tolerance(self) -> float | None:
        """Largest distance (mm of the finished piece) of meshes from the true surface: in proportion where parts are
        large, well below the clearance of pins; None: the usual one.
        """
        large = min(self.finished, COARSEST * self.pivot.fit.running * self.finished / TOLERANCE)
        return TOLERANCE * large if large > 1.0 else None

    @property
    def screw(self) -> float:
        """Nominal diameter (mm of the finished piece) of the screws of a pedestal: the standard one next to 3 rmm; 0
        where all are too thick.
        """
        nearest = min(SOCKET, key=lambda size: abs(size - 3.0 * self.finished))
        return nearest if nearest <= THICKEST_SCREW * self.finished else 0.0


def sizes(shortest: float, overall: float, fit: Fit | None = None, thinnest: float = THINNEST) -> list[Sizes]:
    """From the shortest distance of two joints of one body and the longer side of what all joints sweep (m); then
    with thinner pins, the last ``thinnest`` times as thick at least.
    """
    pin = standard(min(mm(shortest) / LEAST_LINK, mm(overall) / OVERALL))
    thinner = [d for d in reversed(STANDARD) if thinnest * pin <= d < pin]
    return [of_pin(d, fit) for d in (pin, *thinner)]


def thin_pins(lengths: Lengths, pin: float) -> str:
    """Return why pins of ``pin`` mm are much thinner than usual in a machine of this size; empty where they are not."""
    shortest, words, own = lengths.shortest
    usual = standard(mm(lengths.overall) / OVERALL)
    if standard(mm(shortest) / LEAST_LINK) * MUCH_THINNER > usual:
        return ""
    return (
        f"pins of {pin:g} mm, because {words} is {mm(own):.3g} mm; a machine of {mm(lengths.overall):.3g} mm "
        f"would have pins of {usual:g} mm. Move the two farther apart, or put them on one place"
    )


def of_pin(diameter: float, fit: Fit | None = None, ratio: float = 1.0) -> Sizes:
    """Sizes that go with pins of this diameter (mm), with washers and circlips that one can buy where there are any.

    ``fit`` in mm; by default what a workshop can make, small or large. Both are those of the finished piece, in the
    ``ratio`` to the machine.
    """
    scale = diameter / PIN
    if fit is None:
        running = min(max(0.2 * scale, 0.16), 0.6)
        axial = min(max(0.4 * scale, 0.16), 2.0)
        fit = Fit(running, Fit.press * scale, axial, Fit.seat * scale)
    of_reference = Fit(fit.running / scale, fit.press / scale, fit.axial / scale, fit.seat / scale)
    return Sizes(scale / ratio, _bought(Pivot(fit=of_reference), diameter, scale), ratio=ratio)


def _bought(pivot: Pivot, diameter: float, scale: float) -> Pivot:
    """With the sizes of standard washers and circlips."""
    ring, clip = shim_ring(diameter, pivot.washer_thickness * scale), CIRCLIPS.get(diameter)
    if ring:
        washer, thickness = ring.outer / scale, ring.thickness / scale
        pivot = replace(pivot, washer=washer, washer_thickness=thickness, washer_buy=ring.name)
    if clip:
        depth = (clip.shaft - clip.groove) / 2 / scale
        pivot = replace(pivot, clip_thickness=clip.thickness / scale, groove_depth=depth, clip_buy=clip.name)
        pivot = replace(pivot, groove_width=clip.width / scale)
    return pivot


def standard(wish: float) -> float:
    """The standard diameter (mm) next below ``wish``; the smallest one if there is none below."""
    if wish >= STANDARD[-1] + 50:
        return 50.0 * (wish // 50)
    return max((d for d in STANDARD if d <= wish * (1 + 1e-9)), default=STANDARD[0])


def refuse_sizes(name: str, pin: float | None, fit: Fit | None) -> None:
    """Raise UserError for sizes that are none."""
    given = {"pin": pin} | ({f"fit.{field}": value for field, value in vars(fit).items()} if fit else {})
    for what, value in given.items():
        if value is not None and not 0 < value < float("inf"):
            raise UserError(f"{name}: {what} is {value} mm; give a positive number")
