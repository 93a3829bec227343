"""The automatic parts, and a press: a punch on the slider, a blank before its die."""

from __future__ import annotations

from mechanisms.automatic import automatic
from mechanisms.slider_crank.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.shapes.units import mm
from shared.shapes.workpieces import block, prism

RAM = (14.0, 8.0, 34.0, 12.0)
"""Half the width of the ram, that of its punch, where the punch begins, its length (mm beyond the slider's block)."""
BLANK, DIE = (5.0, 26.0), (34.0, 40.0)
"""Thickness of the blank and half its width; depth of the die and half its width (mm)."""
GAP = 0.5
"""Between punch and blank at the end of the stroke (mm)."""


def parts(p: Params) -> Bodies:
    """By body."""
    made = automatic(build(p))
    (wide, narrow, long, punch), (thick, half), (deep, broad) = RAM, BLANK, DIE
    front = 2.0 * made.sizes.eye * made.sizes.scale
    end = mm(((p.rod + p.crank) ** 2 - p.offset**2) ** 0.5) + front + long + punch + GAP
    y = mm(p.offset)
    made.base_under((end + thick + deep, y - broad), (end + thick + deep, y + broad))
    solids = made.solids()
    low, high = made.span("slider")
    tip = front + long + punch
    ram = [(front, -wide), (front + long, -wide), (front + long, -narrow), (tip, -narrow)]
    seat = made.sizes.pivot.fit.seat
    punched = prism([*ram, *((u, -v) for u, v in reversed(ram))], low, high, 0.8)
    solids.dress("slider", Solid("punch", punched, "steel", 0))
    die = block((end + thick + seat, y - broad, end + thick + deep, y + broad), seat, high + 6.0, 1.5)
    blank = block((end, y - half, end + thick, y + half), seat, high + 3.0, 0.4)
    solids.dress("ground", Solid("die", die, "cast_iron", 0), Solid("blank", blank, "brass", 0))
    return solids
