"""Stands of machines whose plane is upright: a lying foot, a column on it, and screw seats (mm).

Axes are those of the machine as it stands: x right, y up, z towards the viewer.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cadquery as cq

from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.screw import SOCKET, head_diameter, socket_screw
from shared.shapes.standards import screw_length, screw_name

type Span = tuple[float, float]
ODD = 0.25
"""A standard screw may differ by this part from the diameter that is wished."""
ROOM = 0.5
"""Between a head and its counterbore (mm, of a screw of 5 mm)."""


@dataclass(frozen=True)
class Bolt:
    """Socket head cap screw: head from z = 0 to z = ``diameter``, shank down to -``length``."""

    shape: cq.Workplane
    diameter: float
    length: float
    head: float
    """Diameter of the head."""
    buy: str = ""

    @property
    def bore(self) -> float:
        """Radius of the hole that it goes through."""
        return 0.54 * self.diameter

    @property
    def seat(self) -> float:
        """Radius of the counterbore of its head."""
        return self.head / 2 + ROOM * self.diameter / 5

    @property
    def sunk(self) -> float:
        """Depth of the counterbore, in which the head is below the face."""
        return 1.1 * self.diameter

    def at_scale(self, ratio: float) -> Bolt:
        """Return the same screw if lengths are counted ``ratio`` times as large."""
        if ratio == 1.0:
            return self
        shape = self.shape.newObject([self.shape.val().scale(ratio)])
        return replace(
            self, shape=shape, diameter=ratio * self.diameter, length=ratio * self.length, head=ratio * self.head
        )


def bolt(wish: float, shortest: float, longest: float) -> Bolt:
    """Return the standard screw next to a diameter ``wish`` with a length between these.

    Without one near, a screw of that diameter is to be made.
    """
    nominal = min(SOCKET, key=lambda size: abs(size - wish))
    length = screw_length(nominal, longest)
    if length is not None and length > max(shortest, 0.7 * longest) and abs(nominal - wish) < ODD * wish:
        return Bolt(socket_screw(nominal, length), nominal, length, head_diameter(nominal), screw_name(nominal, length))
    plain, scale = socket_screw(5.0, 5.0 * longest / wish), wish / 5.0
    return Bolt(plain.newObject([plain.val().scale(scale)]), wish, longest, head_diameter(5.0) * scale)


def foot(x: Span, y: Span, z: Span, corner: float, edge: float) -> cq.Workplane:
    """Return a lying slab, round at its corners, its upper edge chamfered by ``edge``. No through hole."""
    lying = extruded(outline.rounded_rectangle(x[0], -z[1], x[1], -z[0], corner), y[1] - y[0], y[0])
    return eased(eased(lying, edge, ">Z", chamfer=True), edge / 3, "<Z", chamfer=True).rotate((0, 0, 0), (1, 0, 0), -90)


def column(middle: float, y: Span, z: Span, widths: Span, corners: Span, edge: float) -> cq.Workplane:
    """Return a post in front of or behind a plate, with chamfered edges and no through hole.

    It is ``widths`` wide at its lower and at its upper end, with round ``corners`` there.
    """
    (foot, head), (low, high) = (width / 2 - corner for width, corner in zip(widths, corners, strict=True)), corners
    below, above = y[0] + low, y[1] - high
    circles = [
        (middle - foot, below, low),
        (middle + foot, below, low),
        (middle + head, above, high),
        (middle - head, above, high),
    ]
    return eased(extruded(outline.hull(circles), z[1] - z[0], z[0]), edge, "<Z or >Z", chamfer=True)


def drilled(
    shape: cq.Workplane, places: Sequence[tuple[float, float, float]], way: str, radius: float, depth: float
) -> cq.Workplane:
    """Return the shape with blind holes from ``places`` on a face, ``depth`` deep.

    They go along "y" or "z" upwards.
    """
    direction = cq.Vector(0, 1, 0) if way == "y" else cq.Vector(0, 0, 1)
    for place in places:
        over = cq.Vector(*place) - direction
        shape = shape.cut(cq.Workplane(obj=cq.Solid.makeCylinder(radius, depth + 1.0, over, direction)))
    return shape


def seated(
    shape: cq.Workplane, places: Sequence[tuple[float, float, float]], way: str, through: float, screw: Bolt
) -> cq.Workplane:
    """Return the shape with counterbored holes for screws that come from below or behind.

    ``places`` are on the lower or rear face, holes go along "y" or "z" through ``through`` of matter. Each is one
    through hole.
    """
    shape = drilled(shape, places, way, screw.bore, through + 1.0)
    return drilled(shape, places, way, screw.seat, screw.sunk)


def screwed(screw: Bolt, place: tuple[float, float, float], way: str) -> cq.Workplane:
    """Return a screw whose head rests at ``place``, its shank along "y" or "z" upwards."""
    turn = 90.0 if way == "y" else 180.0
    return screw.shape.rotate((0, 0, 0), (1, 0, 0), turn).translate(place)
