"""All solids of a machine along a shaft (mm)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.assembly import kernel_refusals, materials
from mechanisms.stages.automatic.layout.plan import free_name
from mechanisms.stages.automatic.layout.planar import convex_hull
from mechanisms.stages.automatic.shafts import link_solids
from mechanisms.stages.automatic.shafts.along import Along
from mechanisms.stages.automatic.shafts.bearings import bore_of
from mechanisms.stages.automatic.shafts.bodies import (
    KNUCKLE_PIN,
    Link,
    LinkEye,
    flange,
    is_carrier,
    knuckle_eyes,
    rod_foot,
)
from mechanisms.stages.automatic.shafts.cylinder_solids import (
    PistonSize,
    bank_solids,
    piston_shape,
    ring_shapes,
    wrist_pin_shape,
)
from mechanisms.stages.automatic.shafts.cylinders import WRIST_PIN
from mechanisms.stages.automatic.shafts.passing import banks
from mechanisms.stages.automatic.shafts.rams import guide_solids, ram_solids
from mechanisms.stages.automatic.shafts.shaft_solids import balanced_webs, built_up, loads, shaft_solid
from mechanisms.stages.automatic.shafts.valves import cam_shape, valve_solids
from mechanisms.stages.automatic.shafts.wheels import wheel_solids
from mechanisms.stages.automatic.standing import BackPlate, Upright
from shared.contract import Mount
from shared.contract.materials import MATERIALS
from shared.shapes.base import base_plate
from shared.shapes.build import eased, extruded
from shared.shapes.kernel import through_holes
from shared.shapes.link import Eye
from shared.shapes.outline import circle, hull
from shared.shapes.solid import Solid, placed

PLATE, FOOT, MARGIN, INSET, ROUND = 10.0, 3.0, 14.0, 11.0, 8.0
"""Base plate: thickness, height of its feet, what it reaches beyond all that stands on it, place of its feet,
radius of its corners (rmm).
"""
SEAT = 0.02
ROD = "aluminium_gold"
"""Material of connecting rods."""


def solids(
    own: Along, wished: Mapping[str, str], mount: Mount, base_under: Sequence[tuple[float, float]] = ()
) -> dict[str, list[Solid]]:
    """Return every piece by body; ``wished`` are materials. The base plate reaches ``base_under`` (mm)."""
    own.refuse()
    named = materials(own.m) | dict(wished)
    made: dict[str, list[Solid]] = {"ground": [*_base(plate_of(own, mount, base_under), mount)]}
    with kernel_refusals(own.m.name, "the parts on ground"):
        made["ground"] += _on_ground(own)
    bodies = [name for name in own.m.bodies if name != "ground" and name not in own.left_out]
    made |= {body: [] for body in bodies}
    for body in sorted(bodies, key=lambda body: body in own.machine.shafts):  # shafts balance what they carry
        with kernel_refusals(own.m.name, f"the parts of '{body}'"):
            made[body] = _of_body(own, body, named[body], body in wished, made)
    for axle in own.axles:
        made[axle.holder] += link_solids.axle_solids(axle, own.machine, own.thickness, own.sizes, own.low)
    return _named(made, own.sizes.tolerance)


def _named(made: dict[str, list[Solid]], tolerance: float | None) -> dict[str, list[Solid]]:
    """Return names of letters, digits and _, each once; main pieces are called like their bodies."""
    taken: set[str] = set()
    mains = {body: free_name("base_plate" if body == "ground" else body, taken) for body in made}
    return {
        body: [
            replace(solid, name=mains[body] if k == 0 else free_name(solid.name, taken), tolerance=tolerance)
            for k, solid in enumerate(solids)
        ]
        for body, solids in made.items()
    }


def plate_of(own: Along, mount: Mount, base_under: Sequence[tuple[float, float]] = ()) -> BackPlate:
    """Return the base plate, below all that moves and round all that stands on it.

    It is a rectangle, or on a stand its hull.
    """
    unit, upright = own.measures.unit, Upright.from_mount(mount)
    places = np.array([upright.seen_place(x, y) for x, y in (*own.feet, *base_under)])
    more = MARGIN * unit
    (x0, y0), (x1, y1) = places.min(axis=0) - more, places.max(axis=0) + more
    corners = float(x0), float(y0), float(x1), float(y1)
    if mount.kind in ("desk", "wall"):
        return BackPlate(corners, own.low, PLATE * unit, unit, SEAT)
    ends = [-1.0, 1.0]
    inner = more - ROUND * unit
    squares = np.concatenate([places + inner * np.array([right, up]) for right in ends for up in ends])
    centres = tuple((float(x), float(y)) for x, y in convex_hull(squares, 1e-6))
    return BackPlate(corners, own.low, PLATE * unit, unit, SEAT, (), centres, ROUND * unit)


def _base(own: BackPlate, mount: Mount) -> list[Solid]:
    """Return the base plate, and its rubber feet where it is on no stand."""
    unit, upright, (x0, y0, x1, y1) = own.unit, Upright.from_mount(mount), own.corners
    if own.hull:
        rim = hull([(x, y, own.corner) for x, y in own.hull])
        plate = eased(extruded(rim, own.thickness, -own.thickness), 0.8 * unit, ">Z", chamfer=True)
    else:
        plate = base_plate(own.corners, own.thickness, ROUND * unit, edge=0.8 * unit)
    pieces = [Solid("base_plate", placed(plate, z=own.top), "aluminium_black", 0)]
    inset, low = INSET * unit, own.back - FOOT * unit - SEAT
    rests = mount.kind in ("desk", "wall")
    places = [(x, y) for x in (x0 + inset, x1 - inset) for y in (y0 + inset, y1 - inset)] if rests else []
    for k, (x, y) in enumerate(places, start=1):
        pieces.append(Solid(f"foot_{k}", extruded(circle(x, y, 8.0 * unit), FOOT * unit, low), "rubber", 0))
    return [replace(solid, shape=upright.in_model(solid.shape)) for solid in pieces]


def _on_ground(own: Along) -> list[Solid]:
    """Return liners with what holds them, and what carries shafts."""
    every = banks(own.cylinders)
    start = own.low + SEAT
    pieces = [solid for bank in every for solid in bank_solids(bank, every, own.fins, start, [*own.valves.values()])]
    pieces += [solid for ram in own.rams.values() for solid in guide_solids(ram, start)]
    for k, bearer in enumerate(own.bearers):
        pieces += link_solids.bearer_solids(bearer, start, "" if len(own.bearers) == 1 else f"_{k + 1}")
    return pieces


def _of_body(own: Along, body: str, material: str, is_wished: bool, made: Mapping[str, Sequence[Solid]]) -> list[Solid]:
    """Return all pieces of a body that moves, its main one first; ``made`` has what a shaft carries."""
    if body in own.machine.links:
        return _link(own, own.machine.links[body], material, is_wished)
    if body in own.cylinders:
        return _piston(own, body, material if is_wished else "aluminium")
    if body in own.rams:
        return ram_solids(own.rams[body], _ram_pin(own), material if is_wished else "steel")
    if body in own.valves:
        return valve_solids(own.valves[body])
    plan = next(plan for plan in own.shafts if plan.shaft.body == body)
    material = material if is_wished else "steel"
    webs = balanced_webs(plan, loads(own.machine, plan.shaft, made), MATERIALS[material].density)
    shape = shaft_solid(plan, webs, own.flywheel(plan))
    for valve in own.valves.values():
        shape = shape.union(cam_shape(valve)) if valve.valve.shaft == body else shape
    pieces = built_up(shape, plan, [pin for pin in plan.pins if any(_is_closed(own, link) for link in pin.links)])
    names = [body, *(f"rear_{body}" for _ in pieces[1:])]
    all_pieces = [Solid(name, piece, material, through_holes(piece)) for name, piece in zip(names, pieces, strict=True)]
    for wheel in own.wheels.wheels_on(body):
        all_pieces += wheel_solids(wheel, plan.seat_radius(wheel.mounted), own.sizes.pivot.fit.seat)
    return all_pieces


def _is_closed(own: Along, body: str) -> bool:
    """Return True if a rod that carries others has a big end of one piece."""
    link = own.machine.links.get(body)
    main = None if link is None else rod_foot(own.machine, link)
    if link is None or main is None or not is_carrier(own.machine, link):
        return False
    return link_solids.splits_at(link, main.x, main.y) is None


def _piston(own: Along, body: str, material: str) -> list[Solid]:
    cylinder = own.cylinders[body]
    piston, link = cylinder.piston, cylinder.piston.link
    rod = own.machine.links.get(link or "")
    thickness = own.measures.shank(rod, own.thickness) if rod is not None else 0.3 * cylinder.bore
    gap = max(own.measures.axial, 0.012 * cylinder.bore)
    c, s = math.cos(piston.turn), math.sin(piston.turn)
    x, y = piston.wrist[0] + s * piston.aside, piston.wrist[1] - c * piston.aside

    def stand(shape: cq.Workplane) -> cq.Workplane:
        return placed(shape, x, y, piston.z, math.degrees(piston.turn))

    size = PistonSize.from_cylinder(cylinder)
    shape = stand(piston_shape(size, thickness, gap))
    pieces = [Solid(body, shape, material, through_holes(shape))]
    for k, ring in enumerate(ring_shapes(size), start=1):
        pieces.append(Solid(f"ring_{body}_{k}", stand(ring), "steel", 1))
    pieces.append(Solid(f"wrist_pin_{body}", stand(wrist_pin_shape(size)), "brass", 1))
    return pieces


def _link(own: Along, link: Link, material: str, is_wished: bool) -> list[Solid]:
    """Return a rod where it has two eyes and drives a piston, else a plate.

    Split at its crank pin where it can be.
    """
    thickness, bore = own.thickness[link.body], own.measures.of_rod(link)
    eyes, bottom, knuckle_pins = _eyes(own, link), link.z - thickness / 2, list[Solid]()
    cuts, main = _cuts(own, link, eyes), rod_foot(own.machine, link)
    big = next((k for k, eye in enumerate(eyes) if main is not None and math.dist(eye[:2], (main.x, main.y)) < 0.01), 0)
    if bore is not None and main is not None and is_carrier(own.machine, link):
        gap, knuckled = own.measures.axial, knuckle_eyes(own.machine, link)
        fork = link_solids.Fork(thickness, flange(thickness, gap), own.measures.shank(link, own.thickness), bore)
        small = next(eye for eye, of in zip(eyes, _distinct(link), strict=True) if of.on in own.cylinders)
        pins = [(eye.x, eye.y) for eye in knuckled]
        pieces = link_solids.cut_up(
            link_solids.carrier_shape((main.x, main.y), eyes[big][2].bore, small, pins, fork), cuts
        )
        for eye in knuckled:
            pin = placed(link_solids.knuckle_pin((eye.x, eye.y), thickness, bore), z=bottom)
            knuckle_pins.append(Solid(f"pin_{eye.joint}", pin, "brass", 1))
    elif bore is not None and len(eyes) == 2 and main is not None:
        pieces = link_solids.rod_pieces((eyes[big], eyes[1 - big]), thickness, bore, cuts)
    else:
        there = eyes or [(0.0, 0.0, Eye(own.sizes.eye * own.measures.unit, 0.0))]
        pieces = link_solids.cut_up(link_solids.plate_shape(link, there, thickness, own.measures.unit), cuts)
    if bore is not None and not is_wished:
        material = ROD
    names = [link.body, *(f"cap_{link.body}" for _ in cuts)]
    made = [Solid(name, placed(it, z=bottom), material, n) for name, (it, n) in zip(names, pieces, strict=True)]
    return [made[0], *knuckle_pins, *made[1:]]


def _cuts(own: Along, link: Link, eyes: Sequence[tuple[float, float, Eye]]) -> tuple[link_solids.Cut, ...]:
    """Return where a link is split: at crank pins, where all else of it lies on one side."""
    cuts = list[link_solids.Cut]()
    reach = max((math.hypot(a.x - b.x, a.y - b.y) for a in link.eyes for b in link.eyes), default=0.0)
    for k, on in enumerate(link.eyes):
        if on.on not in own.machine.shafts:
            continue
        x, y, eye = eyes[k]
        towards = link_solids.splits_at(link, x, y)
        if towards is not None:
            cuts.append(((x, y), towards, reach + 2 * eye.radius))
    return tuple(cuts)


def _eyes(own: Along, link: Link) -> list[tuple[float, float, Eye]]:
    return [(eye.x, eye.y, Eye(own.measures.eye(link, eye), _bore(own, link, eye))) for eye in _distinct(link)]


def _distinct(link: Link) -> list[LinkEye]:
    """Return eyes without repeats at one place."""
    eyes: list[LinkEye] = []
    for eye in link.eyes:
        if all(math.hypot(eye.x - other.x, eye.y - other.y) > 0.01 for other in eyes):
            eyes.append(eye)
    return eyes


def _bore(own: Along, link: Link, eye: LinkEye) -> float:
    if eye.on in own.machine.shafts:
        plan = next(plan for plan in own.shafts if plan.shaft.body == eye.on)
        return 2 * (plan.pin + max(0.12, 0.1 * own.measures.unit))
    if eye.on in own.cylinders:
        return 2 * (WRIST_PIN * own.cylinders[eye.on].bore + max(0.12, 0.1 * own.measures.unit))
    if eye.on in own.rams:
        return 2 * _ram_pin(own) + own.sizes.pivot.fit.running * own.measures.unit
    if eye in knuckle_eyes(own.machine, link):
        return 2 * (KNUCKLE_PIN * (own.measures.of_rod(link) or 0.0) + max(0.12, 0.1 * own.measures.unit))
    axle = next(
        (
            candidate
            for candidate in own.axles
            if link.body in candidate.places and math.dist(candidate.places[link.body], (eye.x, eye.y)) < 0.01
        ),
        None,
    )
    return bore_of(axle, link.body, own.sizes) * 1.0 if axle else 0.0


def _ram_pin(own: Along) -> float:
    """Return the radius of the pins of rams."""
    return own.sizes.pivot.pin * own.measures.unit / 2
