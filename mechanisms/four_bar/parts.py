"""The solids of the four-bar, in millimetres: crank below, coupler in the middle, rocker on top.

Each joint's pin is held by one body and runs in the bushings of the other. z = 0 is the top of the base plate.
"""

from __future__ import annotations

from mechanisms.four_bar.mechanism import Params
from shared.shapes.base import base_plate, bolt_circle, foot, pedestal
from shared.shapes.engraving import dial, engraved, rule, text
from shared.shapes.link import Eye, link, plate_link
from shared.shapes.pin import Head, pin, stylus
from shared.shapes.pivot import Pivot
from shared.shapes.screw import socket_screw
from shared.shapes.solid import Solid, placed
from shared.shapes.units import mm

PIVOT = Pivot()
PLATE, FOOT = 12.0, 3.0
PEDESTAL_A = 8.0
CRANK, COUPLER, ROCKER = 7.0, 6.0, 7.0
"""Thickness of the links."""
CRANK_BOSS = 4.4
"""Lifts the coupler over the end of pin A."""
PIN_END = 1.2
"""What a pin shows beyond its circlip."""
HEAD = Head(14.0, 4.0, 1.6)
TIP = 14.4
"""Of the stylus above the coupler: its trail passes over the rocker and the head of pin C."""

# Heights, from the base up: each link lies between its number and its number + thickness.
Z_CRANK = PEDESTAL_A + PIVOT.washer_room + PIVOT.fit.axial + PIVOT.flange_room
Z_COUPLER = Z_CRANK + CRANK + CRANK_BOSS + PIVOT.washer_room + PIVOT.fit.axial + PIVOT.flange_room
Z_ROCKER = Z_COUPLER + COUPLER + PIVOT.flange_room + PIVOT.fit.axial + PIVOT.washer_room + PIVOT.flange_room
PEDESTAL_D = Z_ROCKER - PIVOT.flange_room - PIVOT.fit.axial - PIVOT.washer_room


def parts(p: Params) -> dict[str, list[Solid]]:
    """Every piece, by the body it moves with; the first of each list is the body's main piece."""
    return {
        "ground": ground(mm(p.ground)),
        "crank": crank(mm(p.crank)),
        "coupler": coupler(mm(p.coupler), (mm(p.tracer[0]), mm(p.tracer[1]))),
        "rocker": rocker(mm(p.rocker)),
    }


def crank(length: float) -> list[Solid]:
    """Turns on pin A; holds pin B in a raised boss."""
    running, held = Eye(13.0, PIVOT.running), Eye(12.5, PIVOT.held, above=CRANK_BOSS, boss=9.5)
    bar = link(length, CRANK, running, held, (17.0, 15.0), fillet=9.0)
    top = Z_CRANK + CRANK + CRANK_BOSS
    head_z = Z_COUPLER + COUPLER + PIVOT.flange_room + PIVOT.fit.axial
    bolt = pin(PIVOT.pin, head_z - Z_CRANK - 0.3, HEAD)
    return [
        Solid("crank", placed(bar, z=Z_CRANK), "aluminium_orange", 2),
        *PIVOT.bushings("A", 0, 0, Z_CRANK, CRANK),
        PIVOT.washer_at("washer_B", length, 0, top + PIVOT.fit.seat),
        Solid("pin_B", placed(bolt, length, z=Z_CRANK + 0.3), "brass", 0),
    ]


def coupler(length: float, p: tuple[float, float]) -> list[Solid]:
    """A windowed plate that runs on pins B and C and carries the stylus at P."""
    eye = Eye(13.0, PIVOT.running)
    tracer = Eye(7.0, 4.0 + PIVOT.fit.press, above=1.5, boss=5.2)
    joints = [(0.0, 0.0, eye), (length, 0.0, eye), (*p, tracer)]
    plate = plate_link(joints, COUPLER, waist=240.0, rims=(2.6, 6.4, 6.4))
    letters = text("B", 6.5, 18.0, 1.4, width=1.3) + text("C", 6.5, length - 18.0, 1.4, width=1.3)
    plate = engraved(plate, letters, COUPLER, depth=0.6)
    top = Z_COUPLER + COUPLER + 1.5 + PIVOT.fit.seat
    return [
        Solid("coupler", placed(plate, z=Z_COUPLER), "aluminium", 4),
        *PIVOT.bushings("B", 0, 0, Z_COUPLER, COUPLER),
        *PIVOT.bushings("C", length, 0, Z_COUPLER, COUPLER),
        Solid("stylus_P", placed(stylus(4.0, COUPLER + 1.0, TIP, 0.9), *p, top), "brass", 0),
    ]


def rocker(length: float) -> list[Solid]:
    """Turns on pin D; holds pin C, which hangs down through the coupler."""
    running, held = Eye(13.0, PIVOT.running), Eye(12.5, PIVOT.held)
    bar = link(length, ROCKER, running, held, (17.0, 14.0), fillet=12.0, pocket=2.2)
    clip = Z_COUPLER - PIVOT.flange_room - PIVOT.retainer_room
    low = clip - PIN_END
    bolt = pin(PIVOT.pin, Z_ROCKER + ROCKER + PIVOT.fit.seat - low, HEAD, PIVOT.groove(clip - low))
    return [
        Solid("rocker", placed(bar, z=Z_ROCKER), "aluminium_blue", 2),
        *PIVOT.bushings("D", 0, 0, Z_ROCKER, ROCKER),
        PIVOT.washer_at("washer_C_high", length, 0, Z_ROCKER - PIVOT.washer_room),
        PIVOT.washer_at("washer_C_low", length, 0, clip + PIVOT.clip_thickness + PIVOT.fit.seat),
        PIVOT.clip_at("circlip_C", length, 0, clip, turn=180),
        Solid("pin_C", placed(bolt, length, z=low), "brass", 0),
    ]


def ground(length: float) -> list[Solid]:
    """Base plate on feet, with a pedestal and a fixed pin at A and at D."""
    x0, y0, x1, y1 = -48.0, -40.0, length + 48.0, 40.0
    corners = [(x, y) for x in (x0 + 12, x1 - 12) for y in (y0 + 12, y1 - 12)]
    bolts = [(x + u, v) for x in (0.0, length) for u, v in bolt_circle(31.0, 3)]
    plate = base_plate((x0, y0, x1, y1), PLATE, 12.0, corners, tapped=[(x, y, 3.4, 9.0) for x, y in bolts])
    marks = rule(length, 0.0, y0 + 3.4) + dial(0.0, 0.0, 22.5, 10.0)
    marks += text("A", 7.0, -34.0, 0.0, width=1.2) + text("D", 7.0, length + 30.0, 0.0, width=1.2)
    for tens in range(0, int(length) + 1, 20):
        marks += text(str(tens), 2.6, tens, y0 + 9.0, width=0.45)
    solids = [Solid("base_plate", engraved(plate, marks, 0.0), "aluminium_black", len(corners))]
    for joint, x, height, link_z, thickness in (
        ("A", 0.0, PEDESTAL_A, Z_CRANK, CRANK),
        ("D", length, PEDESTAL_D, Z_ROCKER, ROCKER),
    ):
        post = pedestal(height - PIVOT.fit.seat, PIVOT.held, 17.0, 20.0, 39.0, 4.0, 3, 3.0, 31.0)
        clip = link_z + thickness + PIVOT.flange_room + PIVOT.retainer_room - PIVOT.clip_thickness
        end = clip + PIVOT.clip_thickness + PIN_END
        bolt = pin(PIVOT.pin, end - 0.5, None, PIVOT.groove(clip - 0.5))
        solids += [
            Solid(f"pedestal_{joint}", placed(post, x, z=PIVOT.fit.seat), "aluminium", 4),
            Solid(f"pin_{joint}", placed(bolt, x, z=0.5), "steel", 0),
            PIVOT.washer_at(f"washer_{joint}_low", x, 0, height + PIVOT.fit.seat),
            PIVOT.washer_at(f"washer_{joint}_high", x, 0, clip - PIVOT.fit.seat - PIVOT.washer_thickness),
            PIVOT.clip_at(f"circlip_{joint}", x, 0, clip, turn=225),
        ]
    screw = socket_screw(3.0, 11.0)
    solids += [
        Solid(f"screw_{i + 1}", placed(screw, x, y, 4.0 + 2 * PIVOT.fit.seat), "steel", 0)
        for i, (x, y) in enumerate(bolts)
    ]
    for i, (x, y) in enumerate(corners):
        solids += [
            Solid(f"corner_screw_{i + 1}", placed(socket_screw(5.0, 8.5), x, y, -5.4 + PIVOT.fit.seat), "steel", 0),
            Solid(f"foot_{i + 1}", placed(foot(18.0, FOOT, 5.4), x, y, -PLATE - PIVOT.fit.seat), "rubber", 1),
        ]
    return solids
