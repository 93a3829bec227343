"""Bones and the muscles that drive them, on an ergometer: what the leg gives goes into a flywheel."""

from math import cos, radians, sin

from mechanisms.automatic import automatic
from mechanisms.bicycle_leg.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.build import eased, extruded
from shared.shapes.leg import FEET, RING, chainring, ergometer, foot, seat, smooth
from shared.shapes.outline import Point
from shared.shapes.solid import Solid
from shared.shapes.units import mm

PIN, TALL = 20.0, 7.5
"""Diameter of the pins, and thickness of the ergometer's tubes (mm)."""
MUSCLES: dict[str, tuple[str, tuple[Point, ...]]] = {
    "knee_extensors": (
        "thigh",
        ((52, 30), (110, 62), (190, 74), (270, 62), (340, 36), (300, 27), (190, 26), (100, 26)),
    ),
    "knee_flexors": (
        "thigh",
        ((50, -32), (100, -27), (190, -27), (290, -28), (340, -36), (260, -66), (170, -78), (90, -62)),
    ),
    "calf": ("shank", ((252, 95), (320, 66), (396, 38), (386, 72), (332, 106), (276, 114))),
    "shin": ("shank", ((140, -28), (210, -46), (300, -54), (370, -38), (390, -30), (300, -26), (210, -26))),
}
"""Muscles by name: the bone that carries each, and its outline in the frame of that bone (mm)."""


def parts(p: Params) -> Bodies:
    """Bones are bars on automatic pins and bushings; their masses are those of mechanism.py."""
    made = automatic(build(p), pin=PIN)
    made.join("shank", foot(mm(p.shank)))
    ring, windows = chainring(*RING)
    made.join("crank", ring, holes=windows, sharp=True)
    for body, material in (("thigh", "pla_white"), ("shank", "pla_white"), ("crank", "aluminium")):
        made.material(body, material)
    hip = -mm(p.hip) * cos(radians(p.slope)), mm(p.hip) * sin(radians(p.slope))
    made.base_under(*FEET)
    solids = made.solids()
    solids.dress("ground", *ergometer(hip, made.sizes.pivot.fit.seat, TALL), seat(hip)[1])
    for name, (body, outline) in MUSCLES.items():
        low, high = made.span(body)
        shape = eased(extruded(smooth(outline), high - low, low), 1.5, ">Z or <Z")
        solids.dress(body, Solid(name, shape, "aluminium_red", 0))
    return solids
