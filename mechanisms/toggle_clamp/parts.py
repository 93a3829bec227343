"""The automatic parts, and what is clamped: a block on a table, under a foot of rubber."""

from __future__ import annotations

from math import degrees

from mechanisms.automatic import automatic
from mechanisms.toggle_clamp.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid, placed
from shared.shapes.units import mm
from shared.shapes.workpieces import block

FOOT = (6.0, 11.0)
"""Half the width of the foot, and its height (mm)."""
EYE = 7.05
"""Radius of the arm's end (rmm)."""
GAP = 0.3
"""Between the foot and the block when the clamp is locked (mm)."""
WORK = (34.0, 40.0, 30.0)
"""Left and right of the foot, and the height of the block (mm)."""
TABLE = 8.0
"""Thickness of the table under the block (mm)."""


def parts(p: Params) -> Bodies:
    """By body."""
    m = build(p)
    sol = m.sweep()
    made = automatic(m, solution=sol)
    half, tall = FOOT
    locked = sol.point("pad").y.argmin()
    x, y = (mm(float(side[locked])) for side in (sol.point("pad").x, sol.point("pad").y))
    eye = EYE * made.sizes.scale
    top = y - eye - tall - GAP
    left, right, high = WORK
    made.base_under((x + right, top - high - TABLE))
    solids = made.solids()
    low, up = made.span("arm")
    seat = made.sizes.pivot.fit.seat
    table = block((x - left - 8.0, top - high - TABLE, x + right, top - high - seat), seat, up + 9.0)
    work = block((x - left, top - high, x + right - 8.0, top), low - 3.0, up + 5.0, 1.5)
    solids.dress("ground", Solid("table", table, "cast_iron", 0), Solid("work", work, "beech", 0))
    foot = placed(block((-half, -eye - tall, half, -eye), low, up), turn=-degrees(float(sol.body("arm").theta[locked])))
    foot = placed(foot, *(mm(side) for side in p.pad))
    solids.dress("arm", Solid("foot", foot, "rubber", 0))
    return solids
