"""The automatic parts, and what is indexed: a table with a piece for each slot, and a mark."""

from __future__ import annotations

from math import cos, pi, sin

import cadquery as cq

from mechanisms.automatic import automatic
from mechanisms.geneva_drive.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.build import eased, extruded
from shared.shapes.outline import circle
from shared.shapes.solid import Solid, placed
from shared.shapes.units import mm
from shared.shapes.workpieces import block, prism

RIM = (0.42, 0.60)
"""Radii of the table's rim, in that of the wheel."""
THICK, SPOKE, PIECE = 4.0, 7.0, (5.0, 9.0)
"""Thickness of the table (mm); half the width of a spoke; radius and height of a piece."""


def parts(p: Params) -> Bodies:
    """By body."""
    made = automatic(build(p))
    distance, rim = mm(p.distance), mm(p.distance) * cos(pi / p.slots)
    reach = max(rim, 0.75 * distance) + 14.0
    made.base_under((-reach, -reach), (distance + rim + 34.0, reach))
    solids = made.solids()
    seat, eye = made.sizes.pivot.fit.seat, made.sizes.eye * made.sizes.scale
    _, top = made.span("wheel")
    high = max(solid.shape.val().BoundingBox().zmax for solid in solids["crank"]) + 1.0
    outer, middle = RIM[1] * rim, sum(RIM) / 2 * rim
    solids.dress("wheel", Solid("table", _table(p.slots, rim, eye, top + seat, high), "aluminium_gold", p.slots + 1))
    for k in range(p.slots):
        turn = pi * (2 * k + 1) / p.slots
        piece = eased(extruded(circle(0, 0, PIECE[0]), PIECE[1], high + THICK + seat), 1.0, ">Z")
        piece = placed(piece, middle * cos(turn), middle * sin(turn))
        solids.dress("wheel", Solid(f"piece_{k + 1}", piece, "aluminium_red" if k == 0 else "steel", 0))
    station = 180.0 + 360.0 / p.slots * (p.slots // 2)
    mark = _mark(outer + 2.0, rim, seat, high)
    solids.dress("ground", Solid("mark", placed(mark, distance, turn=station), "brass", 0))
    return solids


def _mark(tip: float, rim: float, low: float, high: float) -> cq.Workplane:
    """An arrow over the wheel, on a post beside it."""
    arrow = prism(
        [(tip, 0.0), (tip + 14.0, -7.0), (rim + 20.0, -7.0), (rim + 20.0, 7.0), (tip + 14.0, 7.0)], high, high + THICK
    )
    return arrow.union(block((rim + 7.0, -7.0, rim + 20.0, 7.0), low, high + 0.5 * THICK, 0.0))


def _table(slots: int, rim: float, eye: float, low: float, high: float) -> cq.Workplane:
    """A rim on spokes, and a collar that lifts it over the roller."""
    inner, outer = RIM[0] * rim, RIM[1] * rim
    hub = 1.25 * eye
    plate = extruded(circle(0, 0, outer), THICK, high).cut(extruded(circle(0, 0, inner), THICK, high))
    for k in range(slots):
        spoke = cq.Workplane().box(inner + 2.0, SPOKE, THICK, centered=(False, True, False)).translate((0, 0, high))
        plate = plate.union(spoke.rotate((0, 0, 0), (0, 0, 1), 180.0 * (2 * k + 1) / slots))
    return plate.union(extruded(circle(0, 0, hub), high + THICK - low, low)).cut(
        extruded(circle(0, 0, 1.02 * eye), high + THICK - low + 2.0, low - 1.0)
    )
