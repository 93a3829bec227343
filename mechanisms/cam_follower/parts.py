"""The automatic parts, and what the cam lifts: a valve in its guide, over a seat on the base.

An arm that swings lifts none.
"""

from __future__ import annotations

from mechanisms.automatic import automatic
from mechanisms.cam_follower.mechanism import RETAINER, Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.build import eased
from shared.shapes.solid import Solid
from shared.shapes.units import mm
from shared.shapes.workpieces import block, prism

STEM, HEAD = 5.5, 34.0
"""Half widths (mm)."""
NECK, RIM = {"valve": 0.192}, (24.0, 5.0)
"""Start of the head over the roller (m), by follower; its height along the seat, and that of its rim (mm)."""
SHORT = 0.148
"""The same without springs, which need length (m)."""
GUIDE = (2.0, 10.0)
"""Guide of the stem where no springs are: distance beyond the open follower, thickness on either side (mm)."""
GAP = 0.4
"""Between head and seat when the valve is closed (mm)."""


def parts(p: Params) -> Bodies:
    """By body."""
    made = automatic(build(p))
    if p.follower == "oscillating":
        return made.solids()
    neck, (rise, rim) = mm(NECK.get(p.follower, SHORT)), RIM
    start = mm(p.base) + (0.0 if p.follower == "flat" else mm(p.roller))
    made.base_under(*((side * (HEAD + 20.0), start + neck + rise + rim + mm(p.lift)) for side in (-1, 1)))
    solids = made.solids()
    low, high = made.span("follower")
    seat, end = made.sizes.pivot.fit.seat, solids["follower"][0].shape.val().BoundingBox().ymax
    begin = mm(RETAINER[1]) if p.follower == "valve" else end + seat
    half = [(STEM, begin), (STEM, neck), (HEAD, neck + rise), (HEAD, neck + rise + rim)]
    valve = prism([*half, *((-x, y) for x, y in reversed(half))], low + 1.0, high - 1.0)
    solids.dress("follower", Solid("valve", eased(valve, 1.0), "steel", 0))
    foot, top = start + neck - 1.0, start + neck + rise - GAP
    for side, name in ((-1, "left"), (1, "right")):
        inner, outer = STEM + 1.5, HEAD + 14.0
        meets = top - rise * (HEAD - inner) / (HEAD - STEM)
        slant = [(inner, foot), (outer, foot), (outer, top), (HEAD, top), (inner, meets)]
        shape = prism([(side * x, y) for x, y in slant], seat, high)
        solids.dress("ground", Solid(f"seat_{name}", shape, "bronze", 0))
        if p.follower != "valve":
            beyond, thick = GUIDE
            ends = sorted((side * inner, side * (inner + thick)))
            guide = block((ends[0], start + end + mm(p.lift) + beyond, ends[1], foot - 3.0), seat, high, 0.8)
            solids.dress("ground", Solid(f"guide_{name}", guide, "brass", 0))
    return solids
