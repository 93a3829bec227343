"""The leg as a leg: wooden thigh and shank with its foot, a crank with a chainring, seat tube and saddle."""

from math import cos, radians, sin

from mechanisms.automatic import automatic
from mechanisms.bicycle_leg.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.leg import dress, seat
from shared.shapes.units import mm

PIN = 20.0


def parts(p: Params) -> Bodies:
    """Outlines of a leg round pins and bushings that come by themselves."""
    made = automatic(build(p), pin=PIN)
    dress(made, mm(p.thigh), mm(p.shank), (mm(p.calf[0]), mm(p.calf[1])))
    solids = made.solids()
    hip = -mm(p.hip) * cos(radians(p.slope)), mm(p.hip) * sin(radians(p.slope))
    solids["ground"] += seat(hip)
    return solids
