"""Valves with tappets, the ports in heads that they close, the seats of their springs, and cams (mm)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.shafts.cylinders import HEAD
from mechanisms.stages.automatic.shafts.mounted.valves import (
    CAM,
    COIL,
    CONE,
    RETAINER,
    RIM,
    STEM,
    TAPPET,
    TULIP,
)
from shared.shapes.build import extruded, turned
from shared.shapes.cam import cam_disc
from shared.shapes.outline import circle
from shared.shapes.solid import Hold, Solid, placed

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.shafts.mounted.valves import ValvePlan

THROAT = 0.74
"""Radius of a port in that of its valve."""
THICK = 0.025
"""Thickness of a retainer, in bores."""
SEAT = 0.02


def along_x(shape: cq.Workplane) -> cq.Workplane:
    """What was turned about z, turned about x instead."""
    return shape.rotate((0, 0, 0), (0, 1, 0), 90)


def valve_solids(own: ValvePlan) -> list[Solid]:
    """A valve with its tappet in one piece, and the retainers of its springs, in the frame of its body."""
    b, r, stem = own.bore, own.radius, STEM * own.bore
    c = 0.01 * b
    low, face = own.low, own.face
    under = face - TAPPET * b
    profile = [(0, low), (r - c, low), (r, low + c), (r, low + RIM * b), (0.7 * r, low + CONE * b)]
    profile += [(stem, low + TULIP * b), (stem, under), (own.tappet - c, under), (own.tappet, under + c)]
    profile += [(own.tappet, face - c / 2), (own.tappet - c / 2, face), (0, face)]
    solids = [Solid(own.valve.body, _in_frame(own, turned(profile)), "steel", 0)]
    for spring, _, retainer in own.springs:
        wide, thick = RETAINER * b, THICK * b
        top = min(retainer + thick, under - SEAT)
        ring = extruded(circle(0, 0, wide), top - retainer, retainer, [circle(0, 0, stem + SEAT)])
        hold = Hold(spring, own.valve.z, COIL * b)
        solids.append(Solid(f"retainer_{spring}", _in_frame(own, ring), "brass", 1, holds=(hold,)))
    return solids


def _in_frame(own: ValvePlan, shape: cq.Workplane) -> cq.Workplane:
    """What was turned about z, with s along it, in the frame of the valve's body where it is closed."""
    valve = own.valve
    marker = own.face + own.clear  # s of the marker on its face
    outward = along_x(shape.translate((0, 0, -marker)))
    return placed(outward, *valve.face, valve.z, math.degrees(valve.turn) + 180.0)


def port_shape(own: ValvePlan, high: float) -> cq.Workplane:
    """What a valve takes out of a head whose upper face is at s = ``high``: recess, port and guide, about x."""
    b, start, gap = own.bore, own.cylinder.top - 1.0, own.running
    recess = own.low + CONE * b + gap
    throat = min(recess + 0.55 * HEAD * b, high - 0.02 * b)
    profile = [(0, start), (own.radius + gap, start), (own.radius + gap, recess), (THROAT * own.radius, recess)]
    profile += [(THROAT * own.radius, throat), (STEM * b + gap, throat), (STEM * b + gap, high + 1), (0, high + 1)]
    return along_x(turned(profile))


def spring_seats(own: ValvePlan) -> list[tuple[str, cq.Workplane]]:
    """Washers between a head and the springs of a valve, about x, by the name of the spring."""
    low = own.cylinder.top + HEAD * own.bore + 2 * SEAT
    inner, outer = STEM * own.bore + own.running, RETAINER * own.bore
    return [
        (name, along_x(extruded(circle(0, 0, outer), seat - low, low, [circle(0, 0, inner)])))
        for name, seat, _ in own.springs
        if seat > low
    ]


def cam_shape(own: ValvePlan) -> cq.Workplane:
    """The cam of a valve, in the frame of its shaft."""
    thick = CAM * own.bore
    return placed(cam_disc(own.cam, thick), z=own.valve.z - thick / 2)
