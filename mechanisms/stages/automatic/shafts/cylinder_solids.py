"""Solids of pistons, and of the block with its liners (mm)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import cadquery as cq

from mechanisms.stages.automatic.body_shapes import first_made
from mechanisms.stages.automatic.shafts.cylinders import HEAD, SMALL_END, WRIST_PIN, Cylinder
from mechanisms.stages.automatic.shafts.passing import DECK, deck_half, deck_range, deck_top
from mechanisms.stages.automatic.shafts.valves import COIL, ValvePlan, along_x, port_shape, spring_seats
from shared.shapes.build import built_once, eased, extruded, turned
from shared.shapes.kernel import through_holes
from shared.shapes.outline import circle
from shared.shapes.solid import Hold, Solid, placed

# A piston with its rings and its wrist pin, and its liner with cooling fins, cut open, with a head (mm).

RINGS = (0.10, 0.19, 0.28)
"""Middles of the grooves below the crown, in bores."""
RING, DEEP = 0.035, 0.055
"""Height and depth of a ring."""
RING_GAP = 0.7
"""Gap of a ring in its liner, in that of the piston."""
SEAT = 0.02
HOLLOW, ROOF = 0.41, 0.1
"""Radius of the room inside a piston, and thickness of its crown above."""
BOSS = 1.6
"""Radius of what holds a wrist pin, in the pin's."""
WINDOW = 0.27
"""So far below its upper end a liner is cut open."""
OPENING = math.radians(78)
"""Half of the angle that is cut out of a liner."""
FINS, FIN = 7, 0.025
"""How many, and their thickness."""


class PistonSize(NamedTuple):
    """All that a piston follows from (mm): pistons of one size are built once."""

    bore: float
    running: float
    """Gap in the liner."""
    crown: float
    skirt: float
    """Heights above and below the wrist pin."""
    aside: float
    """Offset of the wrist pin from the middle."""

    @classmethod
    def from_cylinder(cls, own: Cylinder) -> PistonSize:
        """Return the size for a cylinder, rounded.

        What follows from the motion differs from bore to bore in its last bits.
        """
        return cls(*(rounded(size) for size in (own.bore, own.running, own.crown, own.skirt, own.piston.aside)))


def rounded(size: float) -> float:
    """Return a length to a millionth of a micrometre."""
    return round(size, 9) + 0.0  # -0 becomes 0


@built_once
def piston_shape(own: PistonSize, thickness: float, gap: float) -> cq.Workplane:
    """Return the piston, from its wrist pin along x; ``thickness`` of the rod in it, ``gap`` beside that."""
    b, r = own.bore, own.bore / 2 - own.running
    top, low, c = own.crown, -own.skirt, 0.012 * own.bore
    profile = [(0.0, low), (r - c, low), (r, low + c)]
    for below in sorted(RINGS, reverse=True):
        middle, half, inner = top - below * b, RING * b / 2 + SEAT, r - DEEP * b - SEAT
        profile += [(r, middle - half), (inner, middle - half), (inner, middle + half), (r, middle + half)]
    profile += [(r, top - c), (r - c, top), (0.0, top)]
    shape = along_x(turned(profile))
    inside, roof = HOLLOW * b, (SMALL_END + 0.04) * b
    room = along_x(extruded(circle(0, 0, inside), top - ROOF * b - low + 1, low - 1))
    shape = shape.cut(room.cut(extruded(circle(0, own.aside, BOSS * WRIST_PIN * b), 2 * b, -b)))
    slot = cq.Workplane().box(roof - low + 1, 2 * inside, thickness + 2 * gap)
    shape = shape.cut(slot.translate(((roof + low - 1) / 2, own.aside, 0)))
    pin = extruded(circle(0, own.aside, WRIST_PIN * b + SEAT), 2 * b, -b)
    return shape.cut(pin)


def ring_shapes(own: PistonSize) -> list[cq.Workplane]:
    """Return the rings, where they are on the piston."""
    b, r = own.bore, own.bore / 2 - own.running
    outer, inner, half = own.bore / 2 - RING_GAP * own.running, r - DEEP * b, RING * b / 2
    middles = [own.crown - below * b for below in RINGS]
    return [
        along_x(turned([(inner, m - half), (outer, m - half), (outer, m + half), (inner, m + half)])) for m in middles
    ]


def wrist_pin_shape(own: PistonSize) -> cq.Workplane:
    """Return a tube along z through the piston."""
    b, r = own.bore, own.bore / 2 - own.running
    wide = WRIST_PIN * b
    reach = abs(own.aside) + wide
    half = math.sqrt(r**2 - reach**2) - 0.02 * b
    at = (0.0, own.aside)
    return extruded(circle(*at, wide), 2 * half, -half, [circle(*at, 0.5 * wide)])


class LinerSize(NamedTuple):
    """All that a liner follows from beside its fins and its window (mm)."""

    bore: float
    outer: float
    low: float
    top: float

    @classmethod
    def from_cylinder(cls, own: Cylinder) -> LinerSize:
        """Return the size for a cylinder, rounded like that of its piston."""
        return cls(*(rounded(size) for size in (own.bore, own.outer, own.low, own.top)))


@built_once
def liner_shape(own: LinerSize, fin: float, window: float) -> cq.Workplane:
    """Return the liner from its lower end (x = own.low) up.

    ``fin`` is the radius of its fins, ``window`` the direction about x, from y towards z (rad), to which it is open.
    """
    b, inner, outer = own.bore, own.bore / 2, own.outer
    low, high = own.low, own.top
    profile: list[tuple[float, float]] = [(inner, low), (outer, low)]
    first, last = low + 0.06 * b, high - (DECK[0] + 0.06) * b
    if fin > outer + 0.02 * b:
        for k in range(FINS):
            middle = first + (last - first) * k / (FINS - 1)
            z0, z1 = middle - FIN * b / 2, middle + FIN * b / 2
            profile += [(outer, z0), (fin, z0), (fin, z1), (outer, z1)]
    profile += [(outer, high), (inner, high)]
    shape = along_x(turned(profile))
    end, far = high - WINDOW * b, 4 * b
    corners = [
        (far * math.cos(window + k * OPENING / 2), far * math.sin(window + k * OPENING / 2)) for k in range(-2, 3)
    ]
    wedge = cq.Workplane("YZ", origin=(low - b, 0, 0)).polyline([(0.0, 0.0), *corners]).close().extrude(end - low + b)
    return shape.cut(wedge)


def head_shape(own: Cylinder, radius: float, valves: Sequence[ValvePlan] = ()) -> cq.Workplane:
    """Return a round head with fins on the liner's upper end, and a plug in its middle.

    With valves it has their ports and guides in its place.
    """
    b, low = own.bore, own.top + SEAT
    high, plug = low + HEAD * b, 0.08 * b
    step = HEAD * b / 5
    profile: list[tuple[float, float]] = [(0, low), (radius, low), (radius, low + step)]
    for k in (1, 3):
        inner = (0.94 if valves else 0.8) * radius
        profile += [(inner, low + k * step), (inner, low + (k + 1) * step)]
        profile += [(radius, low + (k + 1) * step), (radius, low + (k + 2) * step)]
    if valves:
        shape = along_x(turned([*profile, (0, high)]))
        for valve in valves:
            shape = shape.cut(port_shape(valve, high).translate((0, 0, valve.valve.z - own.piston.z)))
        return shape
    profile += [(2 * plug, high), (2 * plug, high + 0.03 * b), (plug, high + 0.03 * b), (plug, high + 0.18 * b)]
    profile += [(0.4 * plug, high + 0.2 * b), (0.4 * plug, high + 0.3 * b), (0, high + 0.3 * b)]
    return along_x(turned(profile))


# Holders of liners on ground: a deck for each bank, and the heads (mm).

SIDE = math.radians(38)
"""How far the windows of cylinders that stand in line look to their side, from along z."""


def bank_solids(
    bank: Sequence[Cylinder],
    others: Sequence[Sequence[Cylinder]],
    fin: Mapping[str, float],
    low: float,
    valves: Sequence[ValvePlan] = (),
) -> list[Solid]:
    """Return liners, heads with seats of valve springs, and the deck from the base plate's z = ``low`` up."""
    solids = []
    for own in bank:
        name = own.piston.body
        shape = _in_place(
            own, liner_shape(LinerSize.from_cylinder(own), rounded(fin[name]), _window(own, bank, others))
        )
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
    below, above = deck_range(bank)
    wide, last = deck_half(bank), bank[-1]
    top = deck_top(last)
    box = cq.Workplane().box(above - below, 2 * wide, top - low, centered=(False, True, False))
    box = box.translate((below, 0, low))
    round_box = first_made([lambda: box.edges("|X and >Z").fillet(0.06 * last.bore), lambda: box])
    shape = first_made([lambda: eased(round_box, 0.012 * last.bore, "|X", True), lambda: round_box])
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
    """Return the direction (rad, from left of a bore towards z) to which its liner is open."""
    if len(bank) == 1:
        return math.pi / 2
    every = [other[0].piston.along for other in others]
    mean = sum(u for u, _ in every), sum(v for _, v in every)
    leans = mean[0] * own.piston.along[1] - mean[1] * own.piston.along[0]
    if math.hypot(*mean) < 1e-6:  # banks against each other are both open upwards
        u, v = own.piston.along
        leans = u if abs(u) > 1e-6 else -v  # and those of one cylinder to one side
    return math.pi / 2 + (-SIDE if leans > 1e-6 else SIDE)
