"""A wooden thigh and shank with its foot, a crank with a chainring, and the bicycle behind them."""

from math import cos, radians, sin

from mechanisms.automatic import automatic
from mechanisms.four_bar_bicycle.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.leg import FRONT, REAR, WHEEL, dress, frame, seat, wheel
from shared.shapes.solid import Solid
from shared.shapes.units import mm
from shared.shapes.workpieces import block

PIN = 20.0
WIDE, TALL = 3.9, 4.0
"""Thickness of the wheels, and of the frame before them, on which the saddle lies (mm)."""
ROAD = (60.0, 14.0, 70.0)
"""Reach of the road beyond the wheels, under them, and out from the base (mm)."""


def parts(p: Params) -> Bodies:
    """Outlines of a leg round automatic pins and bushings."""
    made = automatic(build(p), pin=PIN)
    dress(made, mm(p.thigh), mm(p.shank), (mm(p.calf[0]), mm(p.calf[1])))
    low, radius = REAR[1] - WHEEL[0], WHEEL[0]
    beyond, thick, deep = ROAD
    left, right = REAR[0] - radius - beyond, FRONT[0] + radius + beyond
    made.base_under((left, low - thick), (right, low - thick))
    solids = made.solids()
    hip = -mm(p.hip) * cos(radians(p.slope)), mm(p.hip) * sin(radians(p.slope))
    z = made.sizes.pivot.fit.seat
    road = block((left, low - thick, right, low - z), z, deep)
    behind = [*wheel("rear", REAR, z, WIDE), *wheel("front", FRONT, z, WIDE), Solid("road", road, "asphalt", 0)]
    _, saddle = seat(hip)
    solids.dress("ground", *behind, frame(hip, 2 * z + WIDE, TALL), saddle)
    return solids
