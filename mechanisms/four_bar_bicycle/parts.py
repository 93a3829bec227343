"""The leg as a leg: wooden thigh and shank with its foot, a crank with a chainring, seat tube and saddle."""

from math import cos, radians, sin

from mechanisms.automatic.automatic import automatic
from mechanisms.four_bar_bicycle.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.leg import calf, chainring, foot, seat, thigh
from shared.shapes.outline import circle
from shared.shapes.units import mm

PIN = 20.0
RING = (95.0, 44, 5, 36.0)
"""Radius, teeth, arms and hub of the chainring."""


def parts(p: Params) -> Bodies:
    """Outlines of a leg round pins and bushings that come by themselves."""
    made = automatic(build(p), pin=PIN)
    made.join("thigh", thigh(mm(p.thigh)))
    made.join("shank", calf(mm(p.shank)), at=(mm(p.shank), 0.0))
    made.join("shank", foot(mm(p.shank)))
    pen = mm(p.calf[0]), mm(p.calf[1])
    made.join("shank", circle(*pen, 20.0), at=pen)
    ring, windows = chainring(*RING)
    made.join("crank", ring, holes=windows, sharp=True)
    for body, material in (("thigh", "beech"), ("shank", "beech"), ("crank", "aluminium")):
        made.material(body, material)
    solids = made.solids()
    hip = -mm(p.hip) * cos(radians(p.slope)), mm(p.hip) * sin(radians(p.slope))
    solids["ground"] += seat(hip)
    return solids
