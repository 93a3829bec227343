"""Wheels of a machine along a shaft: their plan and their solids (mm)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property

from mbsd.model.joint import Joint
from mbsd.model.teeth import with_radii
from mechanisms.stages.automatic.assembly import scaled
from mechanisms.stages.automatic.layout.layout import Layout
from mechanisms.stages.automatic.layout.planar import Rounded, disc
from mechanisms.stages.automatic.shafts.bodies import SAME, Machine, Mounted, place, plane
from mechanisms.stages.automatic.shafts.passing import Takes
from mechanisms.stages.automatic.shafts.shaft_plan import Measures
from mechanisms.stages.automatic.wheels.gears import Mesh, in_phase, refuse_apart, wheel_at
from mechanisms.stages.automatic.wheels.pulleys import BELT, Belt, Pulley, belt_of, rim_of
from mechanisms.stages.automatic.wheels.wheels import HUB, Wheel, shape_of
from shared.shapes.kernel import through_holes
from shared.shapes.link import Eye
from shared.shapes.solid import Solid, placed
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Gears and pulleys on shafts, each in the plane of its joint: in phase, and with the room of their belts (mm).
#
# Teeth, modules and seats of chains are those of wheels in layers (mechanisms/stages/automatic/wheels), in reference
# millimetres; here they get a place along the normal.

GEARS, BELTS = "gear_pair", "belt"


@dataclass(frozen=True, eq=False)
class ShaftWheel:
    """A wheel (rmm) and the plane of its middle (mm)."""

    wheel: Wheel
    z: float
    thickness: float
    unit: float
    """Millimetres in a reference millimetre."""

    @property
    def outside(self) -> float:
        """Its outer radius."""
        return self.wheel.outside * self.unit

    @property
    def mounted(self) -> Mounted:
        """As its shaft's plan sees it."""
        inner = (self.wheel.root - 2.0) * self.unit
        return Mounted(self.wheel.what, self.z, self.thickness, self.outside, inner, True)


@dataclass(frozen=True, eq=False)
class Wheels:
    """All wheels and belts of a machine."""

    machine: Machine
    measures: Measures
    every: list[ShaftWheel] = field(default_factory=list)
    belts: list[tuple[Belt, float]] = field(default_factory=list)
    """Belts (rmm), each with the plane of its middle (mm)."""

    def wheels_on(self, body: str) -> list[ShaftWheel]:
        """Return the wheels of a shaft, each once."""
        return [wheel for wheel in self.every if wheel.wheel.body == body]

    def takes(self) -> Iterable[Takes]:
        """Yield discs, and the strands of the belts at rest on ground."""
        unit = self.measures.unit
        for own in self.every:
            wheel = own.wheel
            mates = frozenset(mate.body for mate in wheel.mates if hasattr(mate, "body"))
            shape = disc(wheel.x * unit, wheel.y * unit, own.outside)
            yield Takes(wheel.what, wheel.body, shape, own.mounted.low, own.mounted.high, mates)
        for belt, z in self.belts:
            on = frozenset(pulley.body for pulley in belt.pulleys)
            for item in belt.items(self.layout):
                shape = Rounded(item.shape.core * unit, item.shape.radius * unit)
                half = 2 * BELT * unit
                yield Takes(item.what, item.body, shape, z - half, z + half, on)

    @cached_property
    def layout(self) -> Layout:
        """The machine in reference millimetres, of which wheels ask poses and places."""
        poses = {
            name: pose / [self.measures.unit, self.measures.unit, 1.0] for name, pose in self.machine.poses.items()
        }
        return Layout(self.machine.m, self.measures.sizes, poses, self.machine.times)


def wheels(machine: Machine, measures: Measures) -> Wheels:
    """Find them.

    Raises UserError naming a joint whose wheels are on no shaft, in no plane or in two, or apart.
    """
    made = Wheels(machine, measures)
    layout, thickness = made.layout, measures.sizes.thickness * measures.unit
    planes: list[tuple[float, list[Wheel]]] = []
    meshes: list[Mesh] = []
    for joint in _joints(machine):
        z = _plane(machine, joint)
        in_plane = next((wheels for at, wheels in planes if abs(at - z) < SAME), None)
        if in_plane is None:
            planes.append((z, in_plane := []))
        if joint.kind.name == BELTS:
            belt = belt_of(machine.m, joint, layout)
            in_plane += belt.pulleys
            made.belts.append((belt, z))
            continue
        sized = with_radii(joint.params)
        first, second = (
            wheel_at(in_plane, joint.name, marker, sized[key], False, layout)
            for marker, key in ((joint.i, "radius_i"), (joint.j, "radius_j"))
        )
        refuse_apart(machine.m, joint, first, second, layout)
        first.mates.append(second)
        second.mates.append(first)
        meshes.append(Mesh(first, second, joint))
    in_phase(machine.m, [mesh_end for mesh in meshes for mesh_end in (mesh.first, mesh.second)], meshes, layout)
    made.every.extend(ShaftWheel(wheel, z, thickness, measures.unit) for z, in_plane in planes for wheel in in_plane)
    return made


def _joints(machine: Machine) -> list[Joint]:
    """Return gears and belts.

    Raises UserError for a ring gear, and for a wheel whose centre is no shaft's axis.
    """
    joints = []
    for joint in machine.m.joints.values():
        if joint.kind.name not in (GEARS, BELTS) or machine.left_out.intersection(joint.bodies):
            continue
        what = f"{machine.m.name}: {joint.kind.name} '{joint.name}'"
        if joint.params.get("internal"):
            raise UserError(
                f"{what} has a ring gear; where bodies have places z there are external gears alone; leave one of its "
                f"bodies out (automatic(m).leave_out), or write {shown_file(machine.m.name, 'parts')}"
            )
        for marker in (joint.i, joint.j):
            shaft = machine.shafts.get(marker.body.name)
            if shaft is None:
                raise UserError(
                    f"{what} has a wheel on '{marker.body.name}', which is no shaft that turns on ground; where bodies "
                    f"have places z wheels are on shafts; write {shown_file(machine.m.name, 'parts')}"
                )
            at = place(marker)
            if math.dist(at, shaft.axis) > SAME:
                raise UserError(
                    f"{what} has its centre on '{marker.body.name}' {math.dist(at, shaft.axis):.4g} mm beside the axis "
                    "of the shaft; put it on the axis"
                )
        joints.append(joint)
    return joints


def _plane(machine: Machine, joint: Joint) -> float:
    """Return where both wheels are (mm)."""
    given = [plane(joint, body) for body in joint.bodies]
    known = [z for z in given if z is not None]
    if not known:
        body = joint.bodies[0]
        raise UserError(
            f"{machine.m.name}: the wheels of '{joint.name}' have no place z along the normal, and other bodies have; "
            f"give a marker one, such as m.bodies['{body}'].at(0, 0, z=0.1)"
        )
    if max(known) - min(known) > SAME:
        raise UserError(
            f"{machine.m.name}: the wheels of '{joint.name}' are at z = {known[0]:g} and {known[-1]:g} mm; wheels that "
            "mesh or have one belt are in one plane: give both markers the same z"
        )
    return known[0]


# The solids of gears and pulleys on shafts (mm): toothed discs with a milled-out web, and rims for belts.

SEAT = 0.02


def wheel_solids(own: ShaftWheel, shaft: float, seat: float) -> list[Solid]:
    """Return a wheel on a shaft of that radius, in the frame of its body.

    ``seat`` (rmm) is between a pulley and its rim.
    """
    wheel, unit = own.wheel, own.unit
    thickness, low = own.thickness / unit, own.mounted.low / unit
    bore = 2 * (shaft + SEAT) / unit
    eye = Eye(max(HUB, bore / 2 + 2.0), bore)
    shape, _ = shape_of(wheel, thickness, [(0.0, 0.0, eye)])
    kind = "pulley" if isinstance(wheel, Pulley) else "gear"
    pieces = [Solid(f"{kind}_{wheel.name}", placed(shape, wheel.x, wheel.y, low), "aluminium", 1)]
    if isinstance(wheel, Pulley):
        pieces.append(rim_of(wheel, thickness, low, seat))
    sized = [scaled(piece, unit) for piece in pieces]
    return [replace(piece, through_holes=through_holes(piece.shape)) for piece in sized]
