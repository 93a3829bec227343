"""Valves of a machine: their plan along the normal, and their solids (mm)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import cadquery as cq
import numpy as np

from mbsd.model.force import Force
from mechanisms.stages.automatic.cams import cut_outline
from mechanisms.stages.automatic.layout.planar import around, box
from mechanisms.stages.automatic.layout.sizes import CLEAR
from mechanisms.stages.automatic.shafts.bodies import Machine, Mounted, Valve, marker_on, place
from mechanisms.stages.automatic.shafts.cylinders import HEAD, Cylinder
from mechanisms.stages.automatic.shafts.passing import Takes
from mechanisms.stages.automatic.shafts.shaft_plan import Measures
from shared.shapes.build import extruded, turned
from shared.shapes.cams import cam_disc, evenly
from shared.shapes.outline import circle
from shared.shapes.solid import Hold, Solid, placed
from shared.shapes.units import mm
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Valves over cylinders, and the cams of the shafts that push them (mm).
#
# Along the middle of a bore, s is counted from abreast of the crankshaft, as in cylinders.py; all proportions are parts
# of the bore. A closed valve lies in a recess of its head.

WIDEST, LEAST = 0.2, 0.08
"""Radius of a valve's head, wished and least."""
BESIDE = 0.02
"""Gap of a valve's head, from the wall of the bore and from the middle between two valves."""
RECESS, RIM, CONE, TULIP = 0.012, 0.02, 0.035, 0.1
"""Heights of a closed valve above the head's face: its lower face; above that its rim, cone and stem begin."""
STEM = 0.04
"""Radius."""
TAPPET, EDGE = 0.06, 0.03
"""Thickness of a tappet, and what it reaches beyond where the cam touches it."""
CAM = 0.17
"""Thickness of a cam."""
RETAINER, COIL = 0.105, 0.08
"""Radii of what a spring pushes against, and of its middle line."""
HULL = 60
"""Points of a cam's outline in the plane."""
ON_LINE = 0.01
"""How far the line of a valve may be beside that of its bore."""


@dataclass(frozen=True, eq=False)
class ValvePlan:
    """A valve with its sizes, its cam, and the cylinder that it opens."""

    valve: Valve
    cylinder: Cylinder
    radius: float
    """Radius of its head."""
    cam: np.ndarray
    """(n, 2): outline of the cam in the frame of its shaft."""
    centre: tuple[float, float]
    """Centre of the cam, in that frame."""
    base: float
    """The least radius of the cam."""
    reach: float
    """How far from the stem's axis the cam touches the tappet."""
    clear: float
    """Between cam and tappet, along the stem."""
    springs: tuple[tuple[str, float, float], ...]
    """Each by its name, with s of the seat on ground and of the retainer while the valve is closed."""

    @property
    def bore(self) -> float:
        """Bore to which all proportions refer."""
        return self.cylinder.bore

    @property
    def face(self) -> float:
        """s of the tappet's face while the valve is closed."""
        (x, y), (u, v) = self.cylinder.origin, self.cylinder.piston.along
        return (self.valve.closed[0] - x) * u + (self.valve.closed[1] - y) * v - self.clear

    @property
    def low(self) -> float:
        """s of its lower face while it is closed."""
        return self.cylinder.top + RECESS * self.bore

    @property
    def running(self) -> float:
        """Gap round its head and its stem."""
        return max(0.15, 0.004 * self.bore)

    @property
    def tappet(self) -> float:
        """Radius of its tappet."""
        return self.reach + EDGE * self.bore

    @property
    def mounted(self) -> Mounted:
        """Its cam, as the plan of the shaft sees it."""
        far = float(np.hypot(*(self.cam - self.centre).T).max())
        return Mounted(f"the cam of '{self.valve.body}'", self.valve.z, CAM * self.bore, far, 0.95 * self.base, False)

    def takes(self) -> Iterable[Takes]:
        """Yield the head, stem and tappet, and the cam."""
        valve, z, on = self.valve, self.valve.z, frozenset(["ground", self.valve.shaft])
        (x, y), turn = valve.face, valve.turn
        u = (math.cos(turn), math.sin(turn))
        start, end = self.clear, self.clear + self.face - self.low
        for what, low, high, half in (
            ("the head of the valve", end - TULIP * self.bore, end, self.radius),
            ("the stem of", start, end, STEM * self.bore),
            ("the tappet of", start, start + TAPPET * self.bore, self.tappet),
        ):
            shape = box((x, y), u, low, high, half)
            yield Takes(f"{what} '{valve.body}'", valve.body, shape, z - half, z + half, on)
        hull = around([(float(p), float(q)) for p, q in evenly(self.cam, HULL)], 0.3)
        mounted = self.mounted
        yield Takes(mounted.what, valve.shaft, hull, mounted.low, mounted.high, frozenset([valve.body]))


def valve_plans(machine: Machine, measures: Measures, cylinders: Mapping[str, Cylinder]) -> dict[str, ValvePlan]:
    """Return valve plans by body.

    Raises UserError naming a valve that is over no cylinder, has no room in one, or stands too low.
    """
    over = {name: _cylinder(machine, valve, cylinders) for name, valve in machine.valves.items()}
    plans = {}
    for name, valve in machine.valves.items():
        own = over[name]
        bore, away = own.bore, abs(valve.z - own.piston.z)
        others = [machine.valves[other].z for other, cylinder in over.items() if cylinder is own and other != name]
        halves = [abs(z - valve.z) / 2 for z in others]
        radius = min([WIDEST * bore, (0.5 - BESIDE) * bore - away, *(half - BESIDE * bore for half in halves)])
        if radius < LEAST * bore:
            raise UserError(
                f"{machine.m.name}: valve '{name}' is {away:.4g} mm along z from the middle of its cylinder with a "
                f"bore of {bore:.4g} mm; that leaves a head of {2 * radius:.3g} mm; put two valves of a cylinder "
                f"{0.47 * bore:.3g} mm apart"
            )
        cam, centre, base = _cam(machine, valve)
        clear = CLEAR * measures.sizes.pivot.fit.running * measures.unit
        plan = ValvePlan(
            valve, own, radius, cam, centre, base, _reach(machine, valve), clear, _springs(machine, valve, own)
        )
        least = plan.low + (TULIP + TAPPET) * bore + valve.lift + HEAD * bore
        if plan.face < least:
            raise UserError(
                f"{machine.m.name}: the tappet of '{name}' is {plan.face:.4g} mm from the crankshaft, and between it "
                f"and the head of its cylinder it needs {least:.4g} mm; move the camshaft away by "
                f"{least - plan.face:.4g} mm"
            )
        plans[name] = plan
    return plans


def _cylinder(machine: Machine, valve: Valve, cylinders: Mapping[str, Cylinder]) -> Cylinder:
    for own in cylinders.values():
        (x, y), (u, v) = own.origin, own.piston.along
        aside = abs((valve.closed[0] - x) * v - (valve.closed[1] - y) * u)
        faces = valve.along[0] * u + valve.along[1] * v < -1 + 1e-6
        if faces and aside < ON_LINE * own.bore and abs(valve.z - own.piston.z) < own.bore / 2:
            return own
    raise UserError(
        f"{machine.m.name}: '{valve.body}' is pushed by the cam of '{valve.cam}' and slides over no cylinder; where "
        "bodies have places z cams push valves alone, along the bore of a piston within half a bore of its place; "
        f"leave it out (automatic(m).leave_out), or write {shown_file(machine.m.name, 'parts')}"
    )


def _cam(machine: Machine, valve: Valve) -> tuple[np.ndarray, tuple[float, float], float]:
    """Return the outline and centre in the frame of its shaft, least radius.

    Raises UserError for what cannot be cut.
    """
    joint = machine.m.joints[valve.cam]
    marker = marker_on(joint, valve.shaft)
    centre, outline = place(marker), cut_outline(machine.m, joint, marker, mm(1.0))
    return outline + np.array(centre), centre, float(np.hypot(*outline.T).min())


def _reach(machine: Machine, valve: Valve) -> float:
    """Return the contact's distance from the cam's axis: ds / dphi, phi its angle."""
    pushed = machine.path(valve.body, *valve.face) @ np.array(valve.along)
    turned = machine.poses[valve.shaft][:, 2]
    steps = np.abs(np.diff(turned))
    moving = steps > 1e-9
    return float((np.abs(np.diff(pushed))[moving] / steps[moving]).max(initial=0.0))


def _springs(machine: Machine, valve: Valve, own: Cylinder) -> tuple[tuple[str, float, float], ...]:
    """Return springs between the valve and ground on the line of its stem."""
    springs = []
    for force in machine.m.forces.values():
        if force.kind.name == "spring" and set(force.bodies) == {"ground", valve.body}:
            ends = _ends(machine, force, valve, own)
            if ends is not None:
                springs.append((force.name, *ends))
    return tuple(springs)


def _ends(machine: Machine, force: Force, valve: Valve, own: Cylinder) -> tuple[float, float] | None:
    on_ground, on_valve = (force.i, force.j) if force.i.body.name == "ground" else (force.j, force.i)
    (x, y), (u, v) = own.origin, own.piston.along
    fixed = np.array(place(on_ground)) - [x, y]
    away = np.array(place(on_valve)) - np.array(valve.face)
    c, s = math.cos(valve.turn), math.sin(valve.turn)
    below, aside = away @ [c, s], abs(away @ [-s, c])
    if abs(fixed @ [-v, u]) > ON_LINE * own.bore or aside > ON_LINE * own.bore:
        return None
    face = (valve.closed[0] - x) * u + (valve.closed[1] - y) * v
    return float(fixed @ [u, v]), face - float(below)


# Valves with tappets, the ports in heads that they close, the seats of their springs, and cams (mm).

THROAT = 0.74
"""Radius of a port in that of its valve."""
THICK = 0.025
"""Thickness of a retainer, in bores."""
SEAT = 0.02


def along_x(shape: cq.Workplane) -> cq.Workplane:
    """Return a shape turned about z as one turned about x."""
    return shape.rotate((0, 0, 0), (0, 1, 0), 90)


def valve_solids(own: ValvePlan) -> list[Solid]:
    """Return a valve with its tappet, and its springs' retainers, in the frame of its body."""
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
    """Return a shape turned about z, with s along it, in the frame of the valve's body where it is closed."""
    valve = own.valve
    marker = own.face + own.clear  # s of the marker on its face
    outward = along_x(shape.translate((0, 0, -marker)))
    return placed(outward, *valve.face, valve.z, math.degrees(valve.turn) + 180.0)


def port_shape(own: ValvePlan, high: float) -> cq.Workplane:
    """Return what a valve cuts out of a head with its upper face at s = ``high``, about x.

    That is recess, port and guide.
    """
    b, start, gap = own.bore, own.cylinder.top - 1.0, own.running
    recess = own.low + CONE * b + gap
    throat = min(recess + 0.55 * HEAD * b, high - 0.02 * b)
    profile = [(0, start), (own.radius + gap, start), (own.radius + gap, recess), (THROAT * own.radius, recess)]
    profile += [(THROAT * own.radius, throat), (STEM * b + gap, throat), (STEM * b + gap, high + 1), (0, high + 1)]
    return along_x(turned(profile))


def spring_seats(own: ValvePlan) -> list[tuple[str, cq.Workplane]]:
    """Return washers between a head and the springs of a valve, about x, by the name of the spring."""
    low = own.cylinder.top + HEAD * own.bore + 2 * SEAT
    inner, outer = STEM * own.bore + own.running, RETAINER * own.bore
    return [
        (name, along_x(extruded(circle(0, 0, outer), seat - low, low, [circle(0, 0, inner)])))
        for name, seat, _ in own.springs
        if seat > low
    ]


def cam_shape(own: ValvePlan) -> cq.Workplane:
    """Return the cam of a valve, in the frame of its shaft."""
    thick = CAM * own.bore
    return placed(cam_disc(own.cam, thick), z=own.valve.z - thick / 2)
