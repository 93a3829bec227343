"""What holds liners on ground: a deck for each bank, and the heads (mm)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.shafts.banks import deck_half, deck_range, deck_top
from mechanisms.stages.automatic.shafts.mounted.valve_solids import spring_seats
from mechanisms.stages.automatic.shafts.mounted.valves import COIL
from mechanisms.stages.automatic.shafts.solids.piston_solids import (
    SEAT,
    LinerSize,
    along_x,
    head_shape,
    liner_shape,
    rounded,
)
from shared.shapes.build import eased, extruded
from shared.shapes.genus import through_holes
from shared.shapes.kernel import first_sound
from shared.shapes.outline import circle
from shared.shapes.solid import Hold, Solid, placed

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.shafts.cylinders import Cylinder
    from mechanisms.stages.automatic.shafts.mounted.valves import ValvePlan

SIDE = math.radians(38)
"""How far the windows of cylinders that stand in line look to their side, from along z."""


def bank_solids(
    bank: Sequence[Cylinder],
    others: Sequence[Sequence[Cylinder]],
    fin: Mapping[str, float],
    low: float,
    valves: Sequence[ValvePlan] = (),
) -> list[Solid]:
    """Liners, heads with the seats of valve springs, and the deck from the base plate (z = ``low``) up."""
    solids = []
    for own in bank:
        name = own.piston.body
        shape = _in_place(own, liner_shape(LinerSize.of(own), rounded(fin[name]), _window(own, bank, others)))
        solids.append(Solid(f"liner_{name}", shape, "aluminium", through_holes(shape)))
        if own.against is not None:
            continue  # the other piston is its head
        radius, above = min(fin[name], 1.25 * own.outer), [plan for plan in valves if plan.cylinder is own]
        shape = _in_place(own, head_shape(own, radius, above))
        solids.append(Solid(f"head_{name}", shape, "aluminium_black", through_holes(shape)))
        for plan in above:
            for spring, washer in spring_seats(plan):
                shape = _turned(own, washer.translate((0, 0, plan.valve.z)))
                hold = Hold(spring, plan.valve.z, COIL * plan.bore)
                solids.append(Solid(f"seat_{spring}", shape, "steel", 1, holds=(hold,)))
    deck = _deck(bank, low)
    solids.append(Solid(f"deck_{bank[0].piston.body}", deck, "aluminium_blue", through_holes(deck)))
    return solids


def _deck(bank: Sequence[Cylinder], low: float) -> cq.Workplane:
    import cadquery as cq

    below, above = deck_range(bank)
    wide, last = deck_half(bank), bank[-1]
    top = deck_top(last)
    box = cq.Workplane().box(above - below, 2 * wide, top - low, centered=(False, True, False))
    box = box.translate((below, 0, low))
    edge = 0.06 * last.bore
    made = first_sound([lambda: box.edges("|X and >Z").fillet(edge)])
    shape = box if made is None else made
    made = first_sound([lambda: eased(shape, 0.012 * last.bore, "|X", True)])
    shape = shape if made is None else made
    for own in bank:
        hole = along_x(extruded(circle(0, 0, own.outer + SEAT), above - below + 2, below - 1))
        shape = shape.cut(hole.translate((0, 0, own.piston.z)))
    return _turned(bank[0], shape)


def _in_place(own: Cylinder, shape: cq.Workplane) -> cq.Workplane:
    return _turned(own, shape.translate((0, 0, own.piston.z)))


def _turned(own: Cylinder, shape: cq.Workplane) -> cq.Workplane:
    u, v = own.piston.along
    return placed(shape, *own.origin, turn=math.degrees(math.atan2(v, u)))


def _window(own: Cylinder, bank: Sequence[Cylinder], others: Sequence[Sequence[Cylinder]]) -> float:
    """Direction about the bore's middle, from left of it towards z (rad), to which its liner is open."""
    if len(bank) == 1:
        return math.pi / 2
    every = [other[0].piston.along for other in others]
    mean = sum(u for u, _ in every), sum(v for _, v in every)
    leans = mean[0] * own.piston.along[1] - mean[1] * own.piston.along[0]
    if math.hypot(*mean) < 1e-6:  # banks against each other are both open upwards
        u, v = own.piston.along
        leans = u if abs(u) > 1e-6 else -v  # and those of one cylinder to one side
    return math.pi / 2 + (-SIDE if leans > 1e-6 else SIDE)
