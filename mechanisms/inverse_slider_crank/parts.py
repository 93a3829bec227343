"""The automatic parts, and what asks for a soft motion: a cup of tea on a tray."""

from mechanisms.automatic import automatic
from mechanisms.inverse_slider_crank.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.shapes.workpieces import CUP, TEA, block, standing

RADIUS = 11.0
"""Radius of the cup (mm)."""
TRAY = (2.4, 34.0)
"""Thickness and depth of the tray (mm)."""


def parts(p: Params) -> Bodies:
    """By body."""
    made = automatic(build(p))
    solids = made.solids()
    thick, deep = TRAY
    low, _ = made.span("slider")
    plate = solids["slider"][0].shape.val().BoundingBox()
    left = plate.xmax + 0.05
    tray = block((left, -thick, left + 3.2 * RADIUS, 0.0), low, low + deep, 0.5)
    x, z = left + 1.6 * RADIUS, low + 0.55 * deep
    solids.dress(
        "slider",
        Solid("tray", tray, "beech", 0),
        Solid("cup", standing(CUP, x, 0.02, z, RADIUS), "pla_white", 0),
        Solid("tea", standing(TEA, x, 0.02, z, RADIUS), "leather", 0),
    )
    return solids
