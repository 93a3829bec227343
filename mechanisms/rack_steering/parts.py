"""The steering's automatic parts, road wheels on stub axles, and a steering wheel.

Lengths in this file are reference millimetres (rmm, sizes.py), scaled when all is made. A road wheel is one with its
knuckle: how it rolls is not part of the motion.
"""

from __future__ import annotations

import cadquery as cq

from mechanisms.automatic import TUBE, Automatic, automatic
from mechanisms.rack_steering.mechanism import Params, build
from shared.shapes.build import extruded, turned
from shared.shapes.outline import circle
from shared.shapes.solid import Solid, placed

LAYER = 4
"""Layer of the knuckles: the axles lie as high as the road wheels need."""
TYRE, RIM, HALF = 46.0, 31.0, 16.0
"""Radii of a tyre and its rim, and half of their width."""
OUT = 58.0
"""Distance from the kingpin to the middle of the wheel."""
AXLE = 5.0
"""Radius of a stub axle."""
STEERING, GRIP = 46.0, 4.0
"""Radii of the steering wheel and of its rim's section."""
RISE = 24.0
"""Height of the steering wheel over the pinion."""


def parts(p: Params) -> dict[str, list[Solid]]:
    """Everything by the body it moves with."""
    m = build(p)
    made = automatic(m, solution=m.sweep())
    for side in ("left", "right"):
        made.layer(f"knuckle_{side}", LAYER)
        made.layer(f"rod_{side}", LAYER - 1)
        made.material(f"knuckle_{side}", "aluminium_red")
        made.material(f"rod_{side}", "aluminium")
    solids = made.solids()
    for side, out in (("left", -1), ("right", 1)):
        solids[f"knuckle_{side}"] += _road_wheel(made, side, out)
    solids["pinion"] += _steering_wheel(made)
    return solids


def _road_wheel(made: Automatic, side: str, out: int) -> list[Solid]:
    """Axle, rim and tyre, in the knuckle's frame; its axle is the x axis."""
    low, high = made.span(f"knuckle_{side}")
    scale = made.sizes.scale
    seat, start = made.sizes.pivot.fit.seat, made.sizes.eye + 0.1
    bevel = HALF - 4.0
    inner, edge = RIM + seat, TYRE - 6.0
    tread = [(TYRE, -bevel), (TYRE + 0.8, 0.0, TYRE, bevel)]
    tyre = turned([(inner, -bevel), (edge, -HALF), *tread, (edge, HALF), (inner, bevel)])
    dish, rim, hole = HALF - 10.0, RIM - 4.0, AXLE + seat
    back = [(hole, -6.0), (12.0, -6.0), (12.0, -2.0), (rim, -2.0), (rim, -bevel), (RIM, -bevel)]
    front = [(RIM, bevel), (rim, bevel), (rim, dish), (14.0, dish), (14.0, bevel), (hole, bevel)]
    hub = turned([*back, *front])
    for k in range(5):
        hub = hub.cut(placed(extruded(circle((rim + 13) / 2, 0, 6.0), 60, -30), turn=72.0 * k))
    axle = extruded(circle(0, 0, AXLE), OUT + bevel - 1.0 - start, start - OUT)
    solids = []
    for name, shape, material, holes in (
        ("axle", axle, "steel", 0),
        ("rim", hub, "aluminium", 6),
        ("tyre", tyre, "rubber", 1),
    ):
        lying = shape.rotate((0, 0, 0), (0, 1, 0), 90.0 * out).translate((out * OUT, 0, (low + high) / 2 / scale))
        solids.append(Solid(f"{name}_{side}", _scaled(lying, scale), material, holes))
    return solids


def _steering_wheel(made: Automatic) -> list[Solid]:
    """On a column over the pinion's pin, in the pinion's frame."""
    scale, (_, top) = made.sizes.scale, made.span("pinion")
    z = top / scale + made.sizes.pivot.fit.seat
    inner, outer = TUBE
    column = extruded(circle(0, 0, outer), RISE - 3.0).cut(extruded(circle(0, 0, inner), RISE - 6.0))
    hub = extruded(circle(0, 0, 15.0), 6.0, RISE - 3.0).faces(">Z").edges().chamfer(1.5)
    shape = column.union(hub)
    for turn in (90.0, 210.0, 330.0):
        spoke = cq.Workplane().box(STEERING, 7.0, 3.5).translate((STEERING / 2, 0, RISE))
        shape = shape.union(placed(spoke, turn=turn))
    shape = shape.union(
        cq.Workplane("XZ").center(STEERING, RISE).circle(GRIP).revolve(360, (-STEERING, 0), (-STEERING, 1))
    )
    return [Solid("steering_wheel", _scaled(placed(shape, z=z), scale), "aluminium_orange", 3)]


def _scaled(shape: cq.Workplane, scale: float) -> cq.Workplane:
    return cq.Workplane(obj=shape.val().scale(scale))
