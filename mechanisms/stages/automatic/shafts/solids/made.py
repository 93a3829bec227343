"""The solids of each body of a machine with places along the normal (mm)."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.assembly.kernel_refusals import kernel_refusals
from mechanisms.stages.automatic.assembly.looks import materials
from mechanisms.stages.automatic.shafts.banks import banks
from mechanisms.stages.automatic.shafts.cylinders import WRIST_PIN
from mechanisms.stages.automatic.shafts.pins_along import bore_of
from mechanisms.stages.automatic.shafts.solids.axle_solids import axle_solids
from mechanisms.stages.automatic.shafts.solids.bearer_solids import bearer_solids
from mechanisms.stages.automatic.shafts.solids.cylinder_block import bank_solids
from mechanisms.stages.automatic.shafts.solids.link_solids import plate_shape, rod_shape, split, splits_at
from mechanisms.stages.automatic.shafts.solids.piston_solids import piston_shape, ring_shapes, wrist_pin_shape
from mechanisms.stages.automatic.shafts.solids.shaft_solid import shaft_solid
from shared.shapes.base import base_plate
from shared.shapes.build import extruded
from shared.shapes.genus import through_holes
from shared.shapes.link import Eye
from shared.shapes.outline import circle
from shared.shapes.solid import Solid, placed

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.shafts.along import Along
    from mechanisms.stages.automatic.shafts.machine import Link, LinkEye

PLATE, FOOT, MARGIN, INSET = 10.0, 3.0, 14.0, 11.0
"""Of the base plate: thickness, height of its feet, what it reaches beyond all that stands on it, place of its feet
(rmm).
"""
SEAT = 0.02
ROD = "aluminium_gold"
"""What connecting rods are made of."""


def solids(
    own: Along, wished: Mapping[str, str], base_under: Sequence[tuple[float, float]] = ()
) -> dict[str, list[Solid]]:
    """Every piece by body; ``wished`` are materials. The base plate reaches ``base_under`` (mm)."""
    own.refuse()
    named = materials(own.m) | dict(wished)
    made: dict[str, list[Solid]] = {"ground": [*_base(own, [*own.feet, *base_under])]}
    with kernel_refusals(own.m.name, "the parts on ground"):
        made["ground"] += _on_ground(own)
    for body in [name for name in own.m.bodies if name != "ground" and name not in own.left_out]:
        with kernel_refusals(own.m.name, f"the parts of '{body}'"):
            made[body] = _of_body(own, body, named[body], body in wished)
    for axle in own.axles:
        made[axle.holder] += axle_solids(axle, own.machine, own.thickness, own.sizes, own.low)
    return _named(made, own.sizes.tolerance)


def _named(made: dict[str, list[Solid]], tolerance: float | None) -> dict[str, list[Solid]]:
    """Names of letters, digits and _, each once; main pieces are called like their bodies."""
    taken: set[str] = set()

    def named(wish: str) -> str:
        name = re.sub(r"\W", "_", wish, flags=re.ASCII)
        name = name if name[:1].isalpha() else f"part_{name}"
        found, number = name, 1
        while found.lower() in taken:
            number += 1
            found = f"{name}_{number}"
        taken.add(found.lower())
        return found

    mains = {body: named("base_plate" if body == "ground" else body) for body in made}
    return {
        body: [
            replace(solid, name=mains[body] if k == 0 else named(solid.name), tolerance=tolerance)
            for k, solid in enumerate(solids)
        ]
        for body, solids in made.items()
    }


def _base(own: Along, feet: Sequence[tuple[float, float]]) -> list[Solid]:
    """The base plate and its rubber feet."""
    unit = own.measures.unit
    xs, ys = [x for x, _ in feet], [y for _, y in feet]
    more = MARGIN * unit
    corners = min(xs) - more, min(ys) - more, max(xs) + more, max(ys) + more
    plate = base_plate(corners, PLATE * unit, 8.0 * unit, edge=0.8 * unit)
    found = [Solid("base_plate", placed(plate, z=own.low), "aluminium_black", 0)]
    inset = INSET * unit
    places = [
        (x, y) for x in (corners[0] + inset, corners[2] - inset) for y in (corners[1] + inset, corners[3] - inset)
    ]
    for k, (x, y) in enumerate(places, start=1):
        low = own.low - (PLATE + FOOT) * unit - SEAT
        found.append(Solid(f"foot_{k}", extruded(circle(x, y, 8.0 * unit), FOOT * unit, low), "rubber", 0))
    return found


def _on_ground(own: Along) -> list[Solid]:
    """Liners with what holds them, and what carries shafts."""
    every = banks(own.cylinders)
    start = own.low + SEAT
    found = [solid for bank in every for solid in bank_solids(bank, every, own.fins, start)]
    for k, one in enumerate(own.bearers):
        found += bearer_solids(one, start, "" if len(own.bearers) == 1 else f"_{k + 1}")
    return found


def _of_body(own: Along, body: str, material: str, is_wished: bool) -> list[Solid]:
    """All pieces of a body that moves, its main one first."""
    if body in own.machine.links:
        return _link(own, own.machine.links[body], material, is_wished)
    if body in own.cylinders:
        return _piston(own, body, material if is_wished else "aluminium")
    plan = next(plan for plan in own.shafts if plan.shaft.body == body)
    shape = shaft_solid(plan, own.flywheel(plan))
    return [Solid(body, shape, material if is_wished else "steel", through_holes(shape))]


def _piston(own: Along, body: str, material: str) -> list[Solid]:
    cylinder = own.cylinders[body]
    piston, link = cylinder.piston, cylinder.piston.link
    thickness = own.thickness[link] if link in own.thickness else 0.3 * cylinder.bore
    gap = max(own.measures.axial, 0.012 * cylinder.bore)
    c, s = math.cos(piston.turn), math.sin(piston.turn)
    x, y = piston.wrist[0] + s * piston.aside, piston.wrist[1] - c * piston.aside

    def at(shape: cq.Workplane) -> cq.Workplane:
        return placed(shape, x, y, piston.z, math.degrees(piston.turn))

    shape = at(piston_shape(cylinder, thickness, gap))
    found = [Solid(body, shape, material, through_holes(shape))]
    for k, ring in enumerate(ring_shapes(cylinder), start=1):
        found.append(Solid(f"ring_{body}_{k}", at(ring), "steel", 1))
    found.append(Solid(f"wrist_pin_{body}", at(wrist_pin_shape(cylinder)), "brass", 1))
    return found


def _link(own: Along, link: Link, material: str, is_wished: bool) -> list[Solid]:
    """A rod where it has two eyes and drives a piston, else a plate; split at its crank pin where it can be."""
    thickness, bore = own.thickness[link.body], own.measures.of_rod(link)
    eyes = _eyes(own, link)
    cranked = [k for k, eye in enumerate(link.eyes) if eye.on in own.machine.shafts]
    bottom = link.z - thickness / 2
    if bore is not None and len(eyes) == 2 and cranked:
        shape, _ = rod_shape([eyes[cranked[0]], eyes[1 - cranked[0]]], thickness, bore)
    else:
        shape, _ = plate_shape(
            link, eyes or [(0.0, 0.0, Eye(own.sizes.eye * own.measures.unit, 0.0))], thickness, own.measures.unit
        )
    shape = placed(shape, z=bottom)
    if bore is not None and not is_wished:
        material = ROD
    found: list[Solid] = []
    for k in cranked:
        x, y, eye = eyes[k]
        towards = splits_at(link, x, y)
        if towards is None:
            continue
        shape, cap = split(shape, (x, y), towards, _reach(link) + 2 * eye.radius)
        found.append(Solid(f"cap_{link.body}", cap, material, through_holes(cap)))
    return [Solid(link.body, shape, material, through_holes(shape)), *found]


def _reach(link: Link) -> float:
    return max(math.hypot(a.x - b.x, a.y - b.y) for a in link.eyes for b in link.eyes)


def _eyes(own: Along, link: Link) -> list[tuple[float, float, Eye]]:
    return [(eye.x, eye.y, Eye(own.measures.eye(link, eye), _bore(own, link, eye))) for eye in _distinct(link)]


def _distinct(link: Link) -> list[LinkEye]:
    """Eyes without repeats at one place."""
    found: list[LinkEye] = []
    for eye in link.eyes:
        if all(math.hypot(eye.x - other.x, eye.y - other.y) > 0.01 for other in found):
            found.append(eye)
    return found


def _bore(own: Along, link: Link, eye: LinkEye) -> float:
    if eye.on in own.machine.shafts:
        plan = next(plan for plan in own.shafts if plan.shaft.body == eye.on)
        return 2 * (plan.pin + max(0.12, 0.1 * own.measures.unit))
    if eye.on in own.cylinders:
        return 2 * (WRIST_PIN * own.cylinders[eye.on].bore + max(0.12, 0.1 * own.measures.unit))
    axle = next(
        (
            one
            for one in own.axles
            if link.body in one.places and math.dist(one.places[link.body], (eye.x, eye.y)) < 0.01
        ),
        None,
    )
    return bore_of(axle, link.body, own.sizes) * 1.0 if axle else 0.0
