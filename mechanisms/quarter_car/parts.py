"""The automatic parts, and round the body's plate the front of a car with its driver (mm)."""

from __future__ import annotations

import cadquery as cq

from mechanisms.automatic import automatic
from mechanisms.quarter_car.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.build import extruded
from shared.shapes.outline import circle
from shared.shapes.solid import Solid
from shared.shapes.units import mm

ARCH = 1.22
"""Radius of the arch over the wheel, in the wheel's."""
SIDE = ((0.62, -0.44), (0.68, -0.36), (0.68, -0.12), (0.55, 0.02), (0.02, 0.14), (-0.26, 0.38), (-0.66, 0.38))
"""Points from the bumper over the bonnet to the roof (m), from the middle of the body."""
SILL, BACK = -0.44, -0.66
WINDOW = ((-0.16, 0.16), (-0.30, 0.32), (-0.59, 0.32), (-0.59, 0.16))
DRIVER = ((-0.41, 0.25, 0.105), (-0.46, 0.03, 0.17))
"""Head and shoulders behind the window: x, y, radius (m). They say how large a car is."""
LAMP = (0.59, -0.12, 0.045)
ROUND = 28.0
"""Radius of the corners."""


def parts(p: Params) -> Bodies:
    """By body."""
    made = automatic(build(p))
    low, high = made.span("body")
    solids = made.solids()
    plate = solids["body"][0]
    seat = extruded(circle(0, 0, 0.5 * made.sizes.eye * made.sizes.scale), 2 * high)  # of the strut's upper end
    front = plate.shape.union(_front(p, high - low).translate((0, 0, low)).cut(seat))
    x, y, radius = (mm(value) for value in LAMP)
    lamp = extruded(circle(x, y, radius - 0.5), 0.5 * (high - low), high - 0.3 * (high - low))
    solids["body"][0] = Solid(plate.name, front, plate.material, plate.through_holes + 1)
    solids["body"].append(Solid("lamp", lamp.faces(">Z").edges().chamfer(0.1 * radius), "pla_white", 0))
    solids.dress("body", Solid("driver", _driver(low + 0.2 * (high - low), high - 0.3 * (high - low)), "beech", 0))
    return solids


def _driver(low: float, high: float) -> cq.Workplane:
    """Return the driver as far as one sees him through the window."""
    window = cq.Workplane().polyline([(mm(x), mm(y)) for x, y in WINDOW]).close().extrude(high - low)
    inside = window.edges("|Z").fillet(ROUND).translate((0, 0, low))
    head, shoulders = (extruded(circle(*(mm(value) for value in part)), high - low, low) for part in DRIVER)
    return head.union(shoulders).intersect(inside)


def _front(p: Params, height: float) -> cq.Workplane:
    """A plate with an arch, a window and the seat of a lamp, from z = 0 up."""
    arch, depth = ARCH * p.radius, p.hub + SILL
    side = (arch**2 - depth**2) ** 0.5
    work = cq.Workplane().moveTo(mm(side), mm(SILL))
    for x, y in SIDE:
        work = work.lineTo(mm(x), mm(y))
    work = work.lineTo(mm(BACK), mm(SILL)).lineTo(mm(-side), mm(SILL))
    work = work.threePointArc((0.0, mm(arch - p.hub)), (mm(side), mm(SILL))).close()
    plate = work.extrude(height).edges("|Z").fillet(ROUND)
    window = cq.Workplane().polyline([(mm(x), mm(y)) for x, y in WINDOW]).close().extrude(height)
    plate = plate.cut(window.edges("|Z").fillet(ROUND)).faces(">Z").edges().chamfer(0.08 * height)
    x, y, radius = (mm(value) for value in LAMP)
    return plate.cut(extruded(circle(x, y, radius), height, 0.6 * height))
