"""The automatic parts, a sheet of paper under both hearts, and a pen at the far end."""

from __future__ import annotations

from mechanisms.automatic import automatic
from mechanisms.pantograph.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid, placed
from shared.shapes.units import mm
from shared.shapes.workpieces import pen, sheet

AROUND = 22.0
"""Margin of the paper beyond both hearts (mm)."""
PAPER, GAP = 0.6, 0.4
"""Thickness of the paper, and between it and the pen (mm)."""


def parts(p: Params) -> Bodies:
    """By body."""
    m = build(p)
    sol = m.sweep()
    made = automatic(m, solution=sol)
    drawn, copy = sol.point("drawn"), sol.point("copy")
    box = (
        mm(float(drawn.x.min())) - AROUND,
        mm(float(copy.y.min())) - AROUND,
        mm(float(copy.x.max())) + AROUND,
        mm(float(copy.y.max())) + AROUND,
    )
    made.base_under((box[2] + 26.0, box[1] - 10.0), (box[2] + 26.0, box[3] + 10.0))
    solids = made.solids()
    seat = made.sizes.pivot.fit.seat
    solids.dress("ground", Solid("paper", sheet(box, seat, PAPER), "paper", 0))
    low, _ = made.span("second")
    shape = placed(pen(seat + PAPER + GAP, low - seat, 3.5), mm(p.arm))
    solids.dress("second", Solid("pen", shape, "aluminium_red", 0))
    return solids
