"""The platform is a table, level over both hinges and as wide as the lift is at its lowest.

It lifts a crate.
"""

from mechanisms.automatic import automatic
from mechanisms.scissor_lift.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.outline import rounded_rectangle
from shared.shapes.solid import Solid
from shared.shapes.units import mm
from shared.shapes.workpieces import crate

BEYOND = 45.0
"""Length of the table beyond the hinge, and beyond where the shoe comes (mm)."""
TOP = (14.0, 42.0)
"""Its lower and upper side over the line of the hinges (mm)."""
CRATE = (62.0, 96.0, 52.0)
"""Half the width of the crate, its height and its depth (mm)."""


def parts(p: Params) -> Bodies:
    """All but the top of the table and the crate is automatic; the crate weighs nothing in the motion."""
    made = automatic(build(p))
    long = mm(p.mean + p.amplitude) + BEYOND
    made.material("platform", "aluminium_red")
    made.join("platform", rounded_rectangle(-BEYOND, TOP[0], long, TOP[1], 4.0), at=(long, TOP[1]))
    solids = made.solids()
    (half, tall, deep), middle = CRATE, (long - BEYOND) / 2
    low, bottom = sum(made.span("platform")) / 2 - 0.35 * deep, TOP[1] + made.sizes.pivot.fit.seat
    load = crate((middle - half, bottom, middle + half, bottom + tall), low, low + deep)
    solids.dress("platform", Solid("crate", load, "beech", 0))
    return solids
