"""The automatic parts, and a pump: a piston on the yoke, its cylinder cut open.

With a spring behind the yoke (variants) there is no room for it.
"""

from __future__ import annotations

import cadquery as cq

from mechanisms.automatic import automatic
from mechanisms.scotch_yoke.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.build import extruded, turned
from shared.shapes.outline import circle
from shared.shapes.solid import Solid
from shared.shapes.units import mm
from shared.shapes.workpieces import block

BORE, WALL, ROD = 19.0, 5.0, 4.4
"""Radius of the cylinder, its wall, and the radius of the piston rod (mm)."""
PISTON, ROOM = 22.0, 4.0
"""Length of the piston, and what it leaves at either end of its stroke (mm)."""
PORT = (3.5, 7.0, 12.0)
"""Radii of a port, and how far it stands out (mm)."""


def parts(p: Params) -> Bodies:
    """By body."""
    made = automatic(build(p))
    if p.tuned:
        return made.solids()
    stroke, block_end = mm(p.crank), mm(p.guide) + 2.0 * made.sizes.eye * made.sizes.scale
    start, rod = block_end + stroke + ROOM, 2 * (stroke + ROOM)
    end = block_end + rod + PISTON + stroke + ROOM
    out = BORE + WALL
    made.base_under((end + WALL + 12.0, out + PORT[2]), (end + WALL + 12.0, -out - PORT[2]))
    solids = made.solids()
    z, seat = sum(made.span("yoke")) / 2, made.sizes.pivot.fit.seat
    solids.dress(
        "yoke",
        Solid("rod", _along(turned([(0, 0), (ROD, 0), (ROD, rod - seat), (0, rod - seat)]), block_end, z), "steel", 0),
        Solid("piston", _along(_piston(), block_end + rod, z), "brass", 0),
    )
    solids.dress(
        "ground",
        Solid("cylinder", _cylinder(start, end, z), "aluminium", 2),
        *(
            Solid(f"saddle_{name}", block((x, -0.8 * out, x + 14.0, 0.8 * out), seat, z - out - seat), "cast_iron", 0)
            for name, x in (("near", start + 6.0), ("far", end - 16.0))
        ),
    )
    return solids


def _along(shape: cq.Workplane, x: float, z: float) -> cq.Workplane:
    """Return a shape that stands along z turned along x, from (x, 0, z)."""
    return shape.rotate((0, 0, 0), (0, 1, 0), 90.0).translate((x, 0.0, z))


def _piston() -> cq.Workplane:
    """With two grooves for rings."""
    r, s = BORE - 1.2, BORE - 2.8
    grooves = [(s, 5.0), (s, 8.0), (r, 8.0), (r, 13.0), (s, 13.0), (s, 16.0), (r, 16.0)]
    return turned([(0, 0), (r, 0), (r, 5.0), *grooves, (r, PISTON), (0, PISTON)])


def _cylinder(start: float, end: float, z: float) -> cq.Workplane:
    """Open at its near end, with two ports before its head, and cut so that one sees in."""
    out, (bore, pipe, stands) = BORE + WALL, PORT
    long = end + WALL - start
    shape = turned([(BORE, 0), (out, 0), (out, long), (0, long), (0, long - WALL), (BORE, long - WALL)])
    shape = _along(shape, start, z)
    x = end - pipe
    for side in (-1.0, 1.0):
        stub = extruded(circle(0, 0, pipe), stands + 1.0, out - 1.0).cut(
            extruded(circle(0, 0, bore), stands + 2.0, out - 1.5)
        )
        hole = extruded(circle(0, 0, bore), WALL + 4.0, BORE - 2.0)
        turned_out = [part.rotate((0, 0, 0), (1, 0, 0), -90.0 * side).translate((x, 0.0, z)) for part in (stub, hole)]
        shape = shape.cut(turned_out[1]).union(turned_out[0])
    return shape.cut(cq.Workplane().box(2 * long, 4 * out, out).translate((start, 0.0, z + pipe + 1.0 + out / 2)))
