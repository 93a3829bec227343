"""Automatic parts of the four-bar, with the rocker above the coupler and marks B and C at its pins."""

from __future__ import annotations

from mechanisms.automatic import automatic
from mechanisms.four_bar.mechanism import Params, build
from shared.shapes.solid import Solid
from shared.shapes.units import mm


def parts(p: Params) -> dict[str, list[Solid]]:
    m = build(p)
    made = automatic(m, solution=m.sweep())
    made.layer("rocker", 2)
    made.engrave("coupler", "B", (18.0, 0.0))
    made.engrave("coupler", "C", (mm(p.coupler) - 18.0, 0.0))
    return made.solids()
