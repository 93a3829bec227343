"""A piston engine in a dozen lines: an ordinary mechanism, each body in its place along the shaft.

    m = engine("V8", bore=0.09, stroke=0.08, rod=0.15, piston_mass=0.5, rod_mass=0.6, speed=300.0)
    sol = m.sweep(steps=720)
    sol.orders(sol.shaking().force)

Bodies are ``crank``, ``rod_1``, ``piston_1`` and so on, in the order of the layout's cylinders; joints ``main``,
``pin_k``, ``wrist_k``, ``bore_k``; the driver ``motor``. The shaft turns counter-clockwise about the origin; the z axis
points from its front, where cylinder 1 is, to its rear.

A rod is replaced by masses at its ends, m_r (1 - s) at the pin and m_r s at the piston, s the place of its centre of
mass in parts of its length: with the inertia m_r s (1 - s) l^2 that is no approximation. A counterweight of the share
f takes the moment (N_k is the number of rods on throw k)

    U_k = r [m_throw + N_k (m_r (1 - s) + f (m_p + m_r s))]

from each throw; f = 1/2 cancels all of the first order that turns with the shaft, whatever the layout. In radial
engines the rods of cylinders 2, 3 and so on hang on ``knuckle_k`` of the master rod ``rod_1``, see
:mod:`mbsd.machines.engines.master_rod`: all cylinders are in one plane, and U_k is that of rods on one pin.

Source: Norton, Design of Machinery, ch. 13 and 14; Maass, Klier 1981, ch. 3.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from mbsd.base.arguments import finite_number, not_negative_number, positive_number
from mbsd.base.errors import ModelError
from mbsd.machines.engines.block import Block
from mbsd.machines.engines.crankshaft import ShaftMasses, crank_sizes, crankshaft, shaft_masses, share_of
from mbsd.machines.engines.firing import firing
from mbsd.machines.engines.layout import SAME, Layout, named
from mbsd.machines.engines.master_rod import NO_RING, Knuckle, MasterRod, Ring, knuckles, ring_of
from mbsd.machines.engines.valve_train import ValveTrain, valve_train
from mbsd.mechanism import Mechanism
from mbsd.model.body import Body
from mbsd.model.cylinders.cycle import GasCycle
from mbsd.model.forces.gas_cycle import gas_cycle
from mbsd.model.laws.formulas import constant_rate, polynomial
from mbsd.model.laws.law import Motion

UPRIGHT = 0.5 * math.pi
SPACE = 1.2
"""Spacing of cylinders beside each other, in bores, where none is given."""


def engine(
    layout: str | Layout,
    *,
    bore: float,
    stroke: float,
    rod: float,
    spacing: float | None = None,
    angle: float | None = None,
    throws: Sequence[float] | None = None,
    split: float | None = None,
    bank_offset: float | None = None,
    rods: str | MasterRod | None = None,
    piston_mass: float | None = None,
    rod_mass: float | None = None,
    rod_com: float = 0.3,
    throw_mass: float = 0.0,
    counterweight: str | float = "auto",
    flywheel: float = 0.0,
    speed: float | None = None,
    acceleration: float | None = None,
    gas: GasCycle | None = None,
    order: Sequence[int] | None = None,
    valves: ValveTrain | None = None,
    block: Block | None = None,
    name: str | None = None,
) -> Mechanism:
    """Return an engine of a layout by name ("V8", "I4", "flat-6", "radial-5", ...) or :class:`Layout`.

    ``bore``, ``stroke``, ``rod`` (m, between pin and wrist pin); ``spacing`` of neighbouring throws along the shaft (m,
    1.2 bores by default); ``angle``, ``throws``, ``split`` (degrees): those of :func:`named`; ``bank_offset``: how far
    rods that share a throw are apart (m, a sixth of the spacing by default). ``rods``: "pin" (all of a throw side by
    side on its pin), "master" or :class:`MasterRod` (one on the pin, the others on knuckle pins of this master rod, all
    in one plane); radial engines have a master rod by default, others none.

    ``piston_mass`` with rings and wrist pin, ``rod_mass`` (kg), or neither: then the bodies have no mass, and in a
    mechanism's folder get that of their parts. ``rod_com``: place of the rod's centre of mass from the crank pin, in
    parts of its length. ``throw_mass``: of one throw at the radius of the pin (kg). ``counterweight``: "auto" (half of
    the oscillating masses), "rotating" (none of them), "none", or the share of them that each throw's counterweight
    balances beside all that rotates. ``flywheel``: moment of inertia of what turns with the shaft (kg m^2). ``speed``
    (rad/s) drives the shaft; with ``acceleration`` (rad/s^2) it runs up by speed t + acceleration t^2 / 2 from
    rest without ``speed``. Without both nothing drives it.

    ``gas``: the cycle of each cylinder, such as ``four_stroke(10.0, heat_density=1.5e6)``, in the firing ``order``
    (numbers of the cylinders, by default the one that fires most evenly); forces ``gas_1`` and so on. ``valves``:
    :class:`ValveTrain` adds overhead camshafts (``camshaft``, or ``camshaft_1`` and ``camshaft_2``) on belts, valves
    ``intake_k`` and ``exhaust_k``, and their springs.

    ``block``: with it shaft and bores are in a body ``block`` on mounts ``mount_1`` and so on, at rest at the start; it
    is to be simulated, and ``m.modes()`` has its natural frequencies. Without it they are in ground.

    Raises ModelError for what cannot be: a rod no longer than the throw, cylinders that overlap, throws that do not fit
    the layout, masses that are negative, an order that the throws do not allow.
    """
    plan = layout if isinstance(layout, Layout) else named(layout, angle, throws, split)
    if isinstance(layout, Layout) and any(value is not None for value in (angle, throws, split)):
        raise ModelError(f"engine '{plan.name}': angle, throws and split are those of its layout; leave them out")
    name = plan.name if name is None else name
    bore, throw, rod = crank_sizes(name, bore, stroke, rod)
    spacing = positive_number(f"engine '{name}': spacing", SPACE * bore if spacing is None else spacing, "m")
    master_rod, hung = knuckles(plan, name, rods, throw, rod, bore)
    z = _places(plan, name, spacing, bank_offset, bool(hung))
    _check_overlaps(plan, name, z, bore)
    masses = shaft_masses(name, piston_mass, rod_mass, rod_com, throw_mass)
    m = Mechanism(name)
    frame = m.ground if block is None else _on_mounts(m, block)
    ring = NO_RING if master_rod is None else ring_of(name, master_rod, hung, rod_mass)
    crank = crankshaft(m, plan, z, throw, share_of(name, counterweight), masses._replace(ring=ring.mass), flywheel)
    m.revolute("main", frame.origin, crank.origin)
    _add_cylinders(m, frame, plan, hung, ring, masses, z, throw, rod)
    if gas is None and valves is None and order is not None:
        raise ModelError(f"engine '{name}': a firing order without gas; give gas=four_stroke(...)")
    if gas is not None or valves is not None:
        fires = _fires(name, plan, hung, gas, order)
        if gas is not None:
            _burn(m, frame, plan, hung, gas, fires, bore=bore, top=throw + rod, stroke=2 * throw)
        if valves is not None:
            _check_valves(name, valves, bool(hung))
            valve_train(m, frame, plan, valves, fires, bore, throw + rod, z, gas, piston_mass is not None)
    _drive(m, frame, _law(name, speed, acceleration), block)
    return m


def _add_cylinders(
    m: Mechanism,
    frame: Body,
    plan: Layout,
    hung: Mapping[int, Knuckle],
    ring: Ring,
    masses: ShaftMasses,
    z: np.ndarray,
    throw: float,
    rod: float,
) -> None:
    """Add rods and pistons, master rods first, and say where the rods start."""
    crank, masters = m.bodies["crank"], {knuckle.master for knuckle in hung.values()}
    leans = [UPRIGHT + c.bank - math.asin(throw / rod * math.sin(c.throw - c.bank)) for c in plan.cylinders]
    poses: dict[str, float] = {}
    for k in sorted(range(len(z)), key=lambda k: k in hung):
        cylinder, place, number = plan.cylinders[k], z[k], k + 1
        pin, axis = UPRIGHT + cylinder.throw, UPRIGHT + cylinder.bank
        x, y = throw * math.cos(pin), throw * math.sin(pin)
        if k in hung:
            knuckle = hung[k]
            con = _rod(m, f"rod_{number}", knuckle.motion.rod, masses.rod, masses.end, place)
            eye = knuckle.radius * math.cos(knuckle.angle), knuckle.radius * math.sin(knuckle.angle)
            m.revolute(f"knuckle_{number}", m.bodies[f"rod_{knuckle.master + 1}"].at(*eye), con.start)
            poses[f"rod_{number}"] = math.degrees(knuckle.rod_starts(leans[knuckle.master], complex(x, y), axis))
        else:
            con = _rod(m, f"rod_{number}", rod, masses.rod, masses.end, place, ring if k in masters else NO_RING)
            m.revolute(f"pin_{number}", crank.at(x, y, z=place), con.start)
            poses[f"rod_{number}"] = math.degrees(leans[k])
        piston = m.body(f"piston_{number}", mass=masses.piston, z=place)
        m.revolute(f"wrist_{number}", con.end, piston.origin)
        m.prismatic(f"bore_{number}", frame.at(0.0, 0.0, axis, z=place), piston.origin)
    m.start_near(**poses)


def _drive(m: Mechanism, frame: Body, law: Motion | None, block: Block | None) -> None:
    """Drive the shaft against ground or against the block it turns in; not at all without a law."""
    if law is None:
        return
    crank = m.bodies["crank"]
    if block is None or block.motor_on == "ground":
        m.drive_angle("motor", crank, law)
    else:
        m.drive_relative_angle("motor", frame, crank, law)


def _law(name: str, speed: float | None, acceleration: float | None) -> Motion | None:
    """Return the angle of the shaft: at a constant speed or, with an acceleration, through a run-up."""
    rate = None if speed is None else finite_number(f"engine '{name}': speed", speed)
    if acceleration is None:
        return None if rate is None else constant_rate(rate)
    return polynomial(0.0, rate or 0.0, 0.5 * finite_number(f"engine '{name}': acceleration", acceleration))


def _rod(
    m: Mechanism, name: str, length: float, mass: float | None, end: float, z: float, ring: Ring = NO_RING
) -> Body:
    """Return a connecting rod, with a ring about its pin."""
    if mass is None or not ring.mass:
        inertia = None if mass is None else mass * end * (1 - end) * length**2
        return m.bar(name, length, mass=mass, com=(end * length, 0.0), inertia=inertia, z=z)
    far, total = mass * end, mass + ring.mass
    inertia = far * (total - far) / total * length**2 + ring.mass * ring.radius**2
    return m.bar(name, length, mass=total, com=(far / total * length, 0.0), inertia=inertia, z=z)


def _on_mounts(m: Mechanism, block: Block) -> Body:
    """Return the block as a body, its frame on the shaft's axis."""
    body = m.body("block", block.mass, block.com, block.inertia)
    for k, mount in enumerate(block.mounts, start=1):
        place = m.ground.at(*mount.at), body.at(*mount.at)
        m.bushing(f"mount_{k}", *place, stiffness=(*mount.stiffness, 0.0), damping=(*mount.damping, 0.0))
    m.start_near(block=(0.0, 0.0, 0.0))
    return body


def _fires(
    name: str, plan: Layout, hung: Mapping[int, Knuckle], gas: GasCycle | None, order: Sequence[int] | None
) -> dict[int, float]:
    """Return the crank angle (rad) at which each cylinder, by its number, fires.

    The first of the order fires at its first top dead centre.
    """
    if gas is not None and not isinstance(gas, GasCycle):
        raise ModelError(f"engine '{name}': gas must be four_stroke(...), two_stroke(...) or pressure_table(...)")
    fired = firing(plan, order, 4 if gas is None else 2 * gas.turns)
    first = plan.cylinders[fired.order[0] - 1]
    begin = (first.bank - first.throw) % (2 * math.pi)
    late = {number: knuckle.late for number, knuckle in ((k + 1, hung_knuckle) for k, hung_knuckle in hung.items())}
    return {
        number: begin + float(since) + late.get(number, 0.0)
        for number, since in zip(fired.order, fired.angles, strict=True)
    }


def _check_valves(name: str, valves: object, has_knuckles: bool) -> None:
    if not isinstance(valves, ValveTrain):
        raise ModelError(f"engine '{name}': valves must be ValveTrain(...)")
    if has_knuckles:
        raise ModelError(
            f"engine '{name}': pistons on a master rod have dead centres of their own, and camshafts are for rods on "
            "crank pins; leave valves out, or take rods='pin'"
        )


def _burn(
    m: Mechanism,
    frame: Body,
    plan: Layout,
    hung: Mapping[int, Knuckle],
    gas: GasCycle,
    fires: Mapping[int, float],
    bore: float,
    top: float,
    stroke: float,
) -> None:
    """Add gas to every cylinder."""
    for number, at in fires.items():
        axis = UPRIGHT + plan.cylinders[number - 1].bank
        piston = m.bodies[f"piston_{number}"]
        knuckle = hung.get(number - 1)
        reach, way = (top, stroke) if knuckle is None else (knuckle.motion.reach, knuckle.motion.stroke)
        roof = reach + (way / (gas.compression - 1.0) if gas.compression else 0.0)
        head = frame.at(roof * math.cos(axis), roof * math.sin(axis), axis + math.pi, z=piston.z)
        gas_cycle(m, f"gas_{number}", head, piston.origin, m.bodies["crank"], gas, bore=bore, fires_at=at)


def _places(plan: Layout, name: str, spacing: float, bank_offset: float | None, one_plane: bool) -> np.ndarray:
    """Return (N,) places of the cylinders along the shaft (m): rods that share a throw stand side by side.

    Rods on a master rod are in ``one_plane``. Raises ModelError.
    """
    if one_plane and bank_offset:
        raise ModelError(
            f"engine '{name}': bank_offset is {1000 * bank_offset:g} mm, but rods on a master rod are in one plane; "
            "leave it out, or take rods='pin'"
        )
    given = 0.0 if one_plane else bank_offset
    apart = spacing / 6 if given is None else not_negative_number(f"engine '{name}': bank_offset", given)
    groups: dict[int, list[int]] = {}
    for k, cylinder in enumerate(plan.cylinders):
        groups.setdefault(round(cylinder.z / SAME), []).append(k)
    z = plan.z * spacing
    for ks in groups.values():
        z[ks] += apart * (np.arange(len(ks)) - 0.5 * (len(ks) - 1))
    for before, after in pairwise(sorted(groups)):
        first, second = groups[before][-1], groups[after][0]
        if len(plan.cylinders) > len(groups) and z[second] - z[first] < SAME * spacing:
            room = 1000 * float(plan.z[second] - plan.z[first]) * spacing
            most = room / max(0.5 * (len(groups[before]) + len(groups[after])) - 1.0, 0.5)
            raise ModelError(
                f"engine '{name}': with a bank_offset of {1000 * apart:.4g} mm rod {first + 1} does not stand before "
                f"rod {second + 1} of the next throw, {room:.4g} mm along the shaft. Make it less than {most:.4g} mm"
            )
    return z


def _check_overlaps(plan: Layout, name: str, z: np.ndarray, bore: float) -> None:
    """Raise ModelError for cylinders of one bank that stand less than a bore apart."""
    for first, cylinder in enumerate(plan.cylinders):
        for second in range(first + 1, len(plan.cylinders)):
            side = math.remainder(cylinder.bank - plan.cylinders[second].bank, 2 * math.pi)
            gap = abs(float(z[first] - z[second]))
            if abs(side) < SAME and gap < bore:
                raise ModelError(
                    f"engine '{name}': cylinders {first + 1} and {second + 1} of one bank are {1000 * gap:.4g} mm "
                    f"apart along the shaft, and the bore is {1000 * bore:g} mm; "
                    + (f"make spacing {bore / gap:.4g} times as large" if gap > 0 else "give them different places z")
                )
