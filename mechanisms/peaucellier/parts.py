"""The automatic parts, and a sheet of paper on which P rules its straight line."""

from mechanisms.automatic import automatic
from mechanisms.peaucellier.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.shapes.units import mm
from shared.shapes.workpieces import sheet

AROUND = (34.0, 22.0)
"""Margins of the paper beside and beyond the line (mm)."""


def parts(p: Params) -> Bodies:
    """By body."""
    m = build(p)
    sol = m.sweep()
    made = automatic(m, solution=sol)
    x, y = mm(float(sol.point("P").x.mean())), mm(float(sol.point("P").y.max()))
    box = (x - AROUND[0], -y - AROUND[1], x + AROUND[0], y + AROUND[1])
    made.base_under((box[2] + 8.0, box[1] - 8.0), (box[2] + 8.0, box[3] + 8.0))
    solids = made.solids()
    solids.dress("ground", Solid("paper", sheet(box, made.sizes.pivot.fit.seat), "paper", 0))
    return solids
