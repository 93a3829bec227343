"""The parts that the model and its motion give; a valve has also a stem and a head, over a seat on the base."""

from __future__ import annotations

import cadquery as cq

from mechanisms.automatic import automatic
from mechanisms.cam_follower.mechanism import RETAINER, Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.build import eased
from shared.shapes.solid import Solid
from shared.shapes.units import mm

STEM, HEAD = 5.5, 34.0
"""Half widths (mm)."""
NECK, RIM = 0.192, (24.0, 5.0)
"""Where the head begins over the roller (m); its height along the seat, and that of its rim (mm)."""
GAP = 0.4
"""Between head and seat when the valve is closed (mm)."""


def parts(p: Params) -> Bodies:
    """By body."""
    made = automatic(build(p))
    solids = made.solids()
    if p.follower != "valve":
        return solids
    low, high = made.span("follower")
    neck, (rise, rim) = mm(NECK), RIM
    half = [(STEM, mm(RETAINER[1])), (STEM, neck), (HEAD, neck + rise), (HEAD, neck + rise + rim)]
    valve = _plate([*half, *((-x, y) for x, y in reversed(half))], low + 1.0, high - 1.0)
    solids["follower"].append(Solid("valve", eased(valve, 1.0), "steel", 0))
    start = mm(p.base + p.roller)
    foot, top = start + neck - 1.0, start + neck + rise - GAP
    for side in (-1, 1):
        inner, outer = STEM + 1.5, HEAD + 14.0
        slant = [
            (inner, foot),
            (outer, foot),
            (outer, top),
            (HEAD, top),
            (inner, top - rise * (HEAD - inner) / (HEAD - STEM)),
        ]
        seat = _plate([(side * x, y) for x, y in slant], made.sizes.pivot.fit.seat, high)
        solids["ground"].append(Solid(f"seat_{'left' if side < 0 else 'right'}", seat, "bronze", 0))
    return solids


def _plate(corners: list[tuple[float, float]], low: float, high: float) -> cq.Workplane:
    """A plate between two heights (mm)."""
    return cq.Workplane().polyline(corners).close().extrude(high - low).translate((0, 0, low))
