"""The automatic parts, a windscreen behind them, and blades of rubber on the wipers."""

from __future__ import annotations

from mechanisms.automatic import automatic
from mechanisms.windshield_wiper.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.build import eased, extruded
from shared.shapes.outline import hull
from shared.shapes.solid import Solid
from shared.shapes.units import mm
from shared.shapes.workpieces import block

GLASS = (5.0, 40.0)
"""Thickness of the windscreen, and how far it goes on beyond what is wiped (mm)."""
CORNER = 46.0
"""Radius of its corners (mm)."""
BLADE = (0.30, 0.99, 3.0)
"""Start and end of a blade, in the length of its wiper; half its width (mm)."""
GAP = 0.5
"""Between blade and glass (mm)."""


def parts(p: Params) -> Bodies:
    """By body."""
    m = build(p)
    sol = m.sweep()
    made = automatic(m, solution=sol)
    solids = made.solids()
    thick, beyond = GLASS
    tips = [sol.point(f"tip_{name}") for name in ("first", "second")]
    left, right = mm(float(tips[0].x.min())) - beyond, mm(float(tips[1].x.max())) + beyond
    top, bottom = mm(p.wiper) + beyond, mm(0.12 * p.wiper)
    lean = 0.12 * (right - left)
    corners = [(left, bottom), (right, bottom), (right - lean, top), (left + lean, top)]
    inside = [(x + (CORNER if x < (left + right) / 2 else -CORNER), y) for x, y in corners]
    rounds = [(x, y + (CORNER if y == bottom else -CORNER), CORNER) for x, y in inside]
    low, high = made.sizes.pivot.fit.seat, made.sizes.pivot.fit.seat + thick
    glass = eased(extruded(hull(rounds), thick, low), 1.0, ">Z or <Z", chamfer=True)
    solids.dress("ground", Solid("windscreen", glass, "glass", 0))
    start, end, half = BLADE
    for name in ("first", "second"):
        under = made.span(name)[0] - made.sizes.pivot.fit.seat
        blade = block((start * mm(p.wiper), -half, end * mm(p.wiper), half), high + GAP, under, 0.8)
        solids.dress(name, Solid(f"blade_{name}", blade, "rubber", 0))
    return solids
