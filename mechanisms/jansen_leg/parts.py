"""The automatic parts, and sand under the foot, which leaves it while it swings forward."""

from mechanisms.automatic import automatic
from mechanisms.jansen_leg.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.shapes.units import mm
from shared.shapes.workpieces import block

BEYOND, THICK = 38.0, 9.0
"""Length of the ground beyond the step, and its thickness under the step (mm)."""
GAP = 0.4
"""Between the foot and the ground (mm)."""


def parts(p: Params) -> Bodies:
    """By body."""
    m = build(p)
    sol = m.sweep()
    made = automatic(m, solution=sol)
    foot = sol.point("foot")
    left, right = mm(float(foot.x.min())) - BEYOND, mm(float(foot.x.max())) + BEYOND
    top = mm(float(foot.y.min())) - 7.05 * made.sizes.scale - GAP
    made.base_under((left, top - THICK), (right, top - THICK))
    solids = made.solids()
    ground = block((left, top - THICK, right, top), made.sizes.pivot.fit.seat, made.span("lower")[1] + 12.0, 0.8)
    solids.dress("ground", Solid("sand", ground, "sand", 0))
    return solids
