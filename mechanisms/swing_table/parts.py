"""The automatic parts, and a cup of tea on the table, which stays level."""

from mechanisms.automatic import automatic
from mechanisms.swing_table.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.shapes.units import mm
from shared.shapes.workpieces import CUP, TEA, block, standing

RADIUS = 26.0
"""Radius of the cup (mm)."""
TRAY = (44.0, 4.0, 62.0)
"""Half the width of the tray, its thickness and its depth (mm)."""


def parts(p: Params) -> Bodies:
    """By body. Tray and cup are before the pivots of the swings, which pass behind them."""
    made = automatic(build(p))
    solids = made.solids()
    x, (half, thick, deep) = mm(p.table) / 2, TRAY
    low = max(solid.shape.val().BoundingBox().zmax for solid in solids["ground"]) + 1.0
    top = solids["table"][0].shape.val().BoundingBox().ymax + made.sizes.pivot.fit.seat
    tray = block((x - half, top, x + half, top + thick), low, low + deep)
    y, z = top + thick + made.sizes.pivot.fit.seat, low + deep / 2
    solids.dress(
        "table",
        Solid("tray", tray, "beech", 0),
        Solid("cup", standing(CUP, x, y, z, RADIUS), "pla_white", 0),
        Solid("tea", standing(TEA, x, y, z, RADIUS), "leather", 0),
    )
    return solids
