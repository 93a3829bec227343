"""The lifter as a jointed wooden mannequin, a bench, and a barbell without its near plates."""

from dataclasses import replace

import cadquery as cq

from mechanisms.hip_thrust.mechanism import Params, arm_angles, build, figure
from shared.shapes import mannequin
from shared.shapes.bodies import Bodies
from shared.shapes.build import eased, extruded, turned
from shared.shapes.outline import rounded_rectangle
from shared.shapes.solid import Solid, placed
from shared.shapes.units import mm

MIDDLE = 340.0
"""Height of the lifter's middle over the base."""
DEEP = 620.0
"""Depth of the floor."""
GAP = 5.5
"""Between the sole and the floor, the back and the pad."""
PAD = (140.0, 480.0, 80.0)
"""Half the width of the bench, its length and thickness."""
BAR, GRIP, SLEEVE, PLATE = 14.0, 19.0, 25.0, 225.0
"""Radii of the bar, of the room for it in a fist, of its sleeve and of its plates."""
FOAM = 34.0
"""Radius of the foam round the bar."""


def parts(p: Params) -> Bodies:
    who = figure(p)
    scale = who.height / 1.78
    thigh, shank, trunk = (mm(who.length(limb)) for limb in ("thigh", "shank", "trunk"))
    leg, arm = mannequin.LEG * scale, mannequin.ARM * scale
    made = Bodies(
        ground=_floor(p),
        foot=mannequin.both_sides(mannequin.foot(scale, mm(who.length("ankle"))), MIDDLE, leg),
        shank=mannequin.both_sides(mannequin.shank(shank, scale), MIDDLE, leg),
        thigh=mannequin.both_sides(mannequin.thigh(thigh, scale), MIDDLE, leg),
        trunk=[_raised(solid) for solid in mannequin.torso(trunk, scale, p.nod)],
        barbell=_barbell(p),
    )
    upper, lower = mm(who.length("upper_arm")), mm(who.reach)
    hangs = p.exercise == "deadlift"
    place = (0.0, 0.0) if hangs else (trunk, 0.0)
    arms = mannequin.arm(upper, lower, scale, place, arm_angles(p), 2 * GRIP)
    made["arms" if hangs else "trunk"] = [
        *made.get("arms" if hangs else "trunk", []),
        *mannequin.both_sides(arms, MIDDLE, arm),
    ]
    if p.exercise != "hip_thrust":  # bent so far, the calf meets the thigh, and that the belly
        for side in ("near", "far"):
            made.pieces_may_touch("torso", f"thigh_{side}")
            made.pieces_may_touch(f"thigh_{side}", f"shank_{side}")
    return made


def _raised(solid: Solid) -> Solid:
    return replace(solid, shape=placed(solid.shape, z=MIDDLE))


def _floor(p: Params) -> list[Solid]:
    """Under the feet, and under the bench where there is one."""
    left, right = (-1450.0, 420.0) if p.exercise == "hip_thrust" else (-650.0, 650.0)
    slab = cq.Workplane().box(right - left, 30.0, DEEP, centered=False).translate((left, -GAP - 30.0, 0.0))
    solids = [Solid("floor", slab.edges("|Z").chamfer(3.0), "aluminium_black", 0)]
    return solids + _bench(p) if p.exercise == "hip_thrust" else solids


def _bench(p: Params) -> list[Solid]:
    """A padded bench whose edge is where the back turns."""
    edge = build(p).joints["pad"].j
    right, top = mm(edge.x) - GAP, mm(edge.y) - GAP
    half, long, thick = PAD
    pad = extruded(rounded_rectangle(right - long, top - thick, right, top, 24.0), 2 * half)
    legs = cq.Workplane().box(44.0, top - thick + GAP - 4.0, 2 * half - 60.0, centered=False)
    foot = cq.Workplane().box(long - 60.0, 30.0, 2 * half - 60.0, centered=False)
    low = MIDDLE - half + 30.0
    stand = foot.translate((right - long + 30.0, -GAP + 0.5, low))
    for x in (right - long + 60.0, right - 104.0):
        stand = stand.union(legs.translate((x, -GAP + 0.5, low)))
    return [
        Solid("bench", eased(pad, 14.0, ">Z or <Z").translate((0, 0, MIDDLE - half)), "leather", 0, tolerance=0.4),
        Solid("stand", stand, "steel", 0),
    ]


def _barbell(p: Params) -> list[Solid]:
    """From the far sleeve with two plates and a collar to the near end, which has none."""
    near, hole = MIDDLE + 320.0, BAR + 0.5
    solids = [
        Solid(
            "shaft", turned([(0, 8), (BAR - 2, 8), (BAR, 10), (BAR, near - 2), (BAR - 2, near), (0, near)]), "steel", 0
        ),
        Solid("sleeve", _ring(SLEEVE, hole, 10.0, 84.0), "steel", 1),
        Solid("collar", _ring(2.0 * SLEEVE, hole, 84.5, 94.0), "steel", 1),
        Solid("plate_outer", _plate(14.0, 42.0), "rubber", 1),
        Solid("plate_inner", _plate(46.0, 80.0), "aluminium_red", 1),
    ]
    if p.exercise == "hip_thrust":
        solids.append(Solid("foam", _ring(FOAM, hole, MIDDLE - 120.0, MIDDLE + 120.0, 8.0), "rubber", 1))
    return [replace(solid, tolerance=0.4) for solid in solids]


def _ring(radius: float, hole: float, low: float, high: float, edge: float = 2.0) -> cq.Workplane:
    r = radius - edge
    return turned([(hole, low), (r, low), (radius, low + edge), (radius, high - edge), (r, high), (hole, high)])


def _plate(low: float, high: float) -> cq.Workplane:
    """A plate with a raised rim and a hub."""
    dent, rim, hub, hole = 0.75 * high + 0.25 * low, 0.84 * PLATE, 0.34 * PLATE, SLEEVE + 0.5
    edge = PLATE - 5.0
    return turned(
        [
            (hole, low), (edge, low), (PLATE, low + 5.0), (PLATE, high - 5.0), (edge, high), (rim, high),
            (rim - 6.0, dent), (hub + 6.0, dent), (hub, high), (hole, high),
        ]
    )  # fmt: skip
