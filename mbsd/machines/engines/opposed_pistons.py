"""Opposed pistons: two in each cylinder, on two shafts that gears join, with the gas between them.

    y(a) = r cos a + sqrt(l^2 - (r sin a)^2)                 a wrist pin from its shaft, a from where the pistons meet
    d = D - y(theta) - y(theta + p) - 2 h                    between the crowns, h above the wrist pins
    F_n = A_n m r w^2 [cos n theta - cos n (theta + p)]      along the cylinder: 2 A_n sin(n p / 2) at most

The upper shaft leads by the phase p, so that its pistons open the exhaust ports first. Without phase all forces of the
pistons cancel, in every order. The crowns are nearest, by symmetry, at theta = -p / 2, and the way between the dead
centres is 4 r cos(p / 2). Where heat is released counts the volume of the slider-crank with

    r' = 2 r cos(p / 2),    l' = 2 l cos(p / 2)^2 / cos p

which has this way, and the same motion but for terms of (r / l)^3; without phase it is exact. Pressures follow the
volume as it is.

Source: Pirault, Flint, Opposed Piston Engines, ch. 2 and 8; Norton, Design of Machinery, ch. 13.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from mbsd.base.arguments import finite_number, not_negative_number, positive_number
from mbsd.base.errors import ModelError
from mbsd.machines.engines.crankshaft import UPRIGHT, ShaftMasses, crank_sizes, crankshaft, shaft_masses, share_of
from mbsd.machines.engines.layout import Layout, layout
from mbsd.mechanism import Mechanism
from mbsd.model.body import Body
from mbsd.model.cylinders.cycle import GasCycle
from mbsd.model.forces.gas_cycle import gas_cycle
from mbsd.model.laws.formulas import constant_rate

SPACE = 1.2
"""Spacing of cylinders, in bores, where none is given."""
CROWN = 0.5
"""Height of a piston above its wrist pin, in bores, where none is given."""
GAP = 0.02
"""Between the crowns where they are nearest, in strokes, without gas."""
TEETH = 60
"""Number of teeth of every gear."""
MOST = 60.0
"""Degrees: a larger phase is a mistake."""


def opposed_pistons(
    throws: Sequence[float] = (0.0,),
    *,
    bore: float,
    stroke: float,
    rod: float,
    phase: float = 0.0,
    opposite: bool = False,
    spacing: float | None = None,
    crown: float | None = None,
    gap: float | None = None,
    piston_mass: float | None = None,
    rod_mass: float | None = None,
    rod_com: float = 0.3,
    throw_mass: float = 0.0,
    counterweight: str | float = "rotating",
    speed: float | None = None,
    gas: GasCycle | None = None,
    name: str = "opposed_pistons",
) -> Mechanism:
    """Return an engine with a cylinder for each of ``throws`` (DEGREES), of two pistons each.

    Each piston has this ``stroke`` (m). The lower shaft ``crank`` turns counter-clockwise about the origin, the
    cylinders stand upright on it, and ``upper_crank`` is above them; bodies and joints of the upper pistons are called
    ``upper_rod_1`` and so on. The upper shaft leads by ``phase`` (DEGREES). By an ``idler`` between them both turn in
    one sense, or, ``opposite``, their gears mesh directly. ``crown``: height of the pistons above their wrist pins (m);
    ``gap``: between the crowns where they are nearest (m), given by the compression of the gas where it has one.
    ``gas``: such as ``two_stroke(15.0, heat_density=1e6)``, between both pistons; it fires at every turn. The other
    arguments are those of :func:`mbsd.machines.engines.engine.engine`.

    Returns a mechanism whose distance between the shafts follows from all this. Raises ModelError for what cannot be.
    """
    bore, throw, rod = crank_sizes(name, bore, stroke, rod)
    lead = math.radians(finite_number(f"engine '{name}': phase", phase))
    if abs(phase) > MOST:
        raise ModelError(
            f"engine '{name}': phase is {phase:g} degrees; the exhaust pistons lead by 5 to 20, {MOST:g} at most"
        )
    apart = SPACE * bore if spacing is None else positive_number(f"engine '{name}': spacing", spacing, "m")
    if len(throws) > 1 and apart < bore:
        raise ModelError(
            f"engine '{name}': cylinders are {1000 * apart:.4g} mm apart along the shafts, and the bore is "
            f"{1000 * bore:g} mm; make spacing larger"
        )
    masses = shaft_masses(name, piston_mass, rod_mass, rod_com, throw_mass)
    high = CROWN * bore if crown is None else not_negative_number(f"engine '{name}': crown", crown, "m")
    way = 4.0 * throw * math.cos(0.5 * lead)
    nearest = _nearest(name, gas, gap, way, stroke)
    between = 2.0 * (_wrist(throw, rod, 0.5 * lead) + high) + nearest
    plan = layout(name, [0.0] * len(throws), throws)
    sense = -1.0 if opposite else 1.0
    upper = layout(name, [180.0] * len(throws), [180.0 + sense * (t + phase) for t in throws])
    m = Mechanism(name)
    z, share = plan.z * apart, share_of(name, counterweight)
    cranks = [
        crankshaft(m, engine, z, throw, share, masses, 0.0, shaft)
        for engine, shaft in ((plan, "crank"), (upper, "upper_crank"))
    ]
    m.revolute("main", m.ground.origin, cranks[0].origin)
    m.revolute("upper_main", m.ground.at(0.0, between), cranks[1].origin)
    _geared(m, cranks, between, float(z.max()) + apart, opposite)
    for crank, engine, prefix, axis, foot in (
        (cranks[0], plan, "", UPRIGHT, 0.0),
        (cranks[1], upper, "upper_", -UPRIGHT, between),
    ):
        _pistons(m, crank, engine, z, (prefix, axis, foot), (throw, rod), masses)
    if gas is not None:
        ratio = 2.0 * rod * math.cos(0.5 * lead) ** 2 / math.cos(lead)
        for k, cylinder in enumerate(plan.cylinders, start=1):
            head, piston = (m.bodies[f"{prefix}piston_{k}"].at(high, 0.0) for prefix in ("upper_", ""))
            fires = -0.5 * lead - cylinder.throw + UPRIGHT  # against the upper piston, which points down
            gas_cycle(
                m, f"gas_{k}", head, piston, cranks[0], gas,
                bore=bore, fires_at=fires, stroke=way, rod=ratio, top=nearest,
            )  # fmt: skip
    if speed is not None:
        m.drive_angle("motor", cranks[0], constant_rate(finite_number(f"engine '{name}': speed", speed)))
    return m


def _nearest(name: str, gas: GasCycle | None, gap: float | None, way: float, stroke: float) -> float:
    """Return the distance between the crowns where they are nearest (m)."""
    given = None if gap is None else positive_number(f"engine '{name}': gap", gap, "m")
    if gas is None:
        return GAP * stroke if given is None else given
    if not isinstance(gas, GasCycle):
        raise ModelError(f"engine '{name}': gas must be two_stroke(...) or pressure_table(...)")
    if gas.turns != 1:
        raise ModelError(
            f"engine '{name}': a cycle of {gas.turns} turns; opposed pistons open ports at every turn, so give "
            "two_stroke(...)"
        )
    if gas.compression:
        own = way / (gas.compression - 1.0)
        if given is not None and abs(given - own) > 1e-9 * way:
            raise ModelError(
                f"engine '{name}': gap is {1000 * given:g} mm, and a compression of {gas.compression:g} makes it "
                f"{1000 * own:.6g} mm; leave it out"
            )
        return own
    if given is None:
        raise ModelError(f"engine '{name}': gas without compression; give gap, the least distance between the crowns")
    return given


def _wrist(throw: float, rod: float, angle: float) -> float:
    return throw * math.cos(angle) + math.sqrt(rod**2 - (throw * math.sin(angle)) ** 2)


def _geared(m: Mechanism, cranks: Sequence[Body], between: float, z: float, opposite: bool) -> None:
    """Add gears of equal size, behind the last cylinder."""
    ends = [crank.at(0.0, 0.0, z=z) for crank in cranks]
    m.start_near(crank=0, upper_crank=0)
    if opposite:
        m.gear_pair("gears", ends[0], ends[1], teeth=(TEETH, TEETH), module=between / TEETH)
        return
    idler = m.body("idler", mass=0.0, inertia=0.0, z=z)
    m.revolute("idler_main", m.ground.at(0.0, 0.5 * between), idler.origin)
    m.start_near(idler=0)
    for name, at in zip(("gears", "upper_gears"), ends, strict=True):
        m.gear_pair(name, at, idler.origin, teeth=(TEETH, TEETH), module=0.5 * between / TEETH)


def _pistons(
    m: Mechanism,
    crank: Body,
    plan: Layout,
    z: np.ndarray,
    where: tuple[str, float, float],
    lengths: tuple[float, float],
    masses: ShaftMasses,
) -> None:
    """Add rods and pistons of one shaft.

    ``where``: prefix of names, direction of cylinders, place of the shaft.
    """
    (prefix, axis, foot), (throw, rod), end = where, lengths, masses.end
    inertia = None if masses.rod is None else masses.rod * end * (1 - end) * rod**2
    for k, (cylinder, place) in enumerate(zip(plan.cylinders, z, strict=True), start=1):
        con = m.bar(f"{prefix}rod_{k}", rod, mass=masses.rod, com=(end * rod, 0.0), inertia=inertia, z=place)
        piston = m.body(f"{prefix}piston_{k}", mass=masses.piston, z=place)
        pin = UPRIGHT + cylinder.throw
        at = throw * math.cos(pin), throw * math.sin(pin)
        m.revolute(f"{prefix}pin_{k}", crank.at(*at, z=place), con.start)
        m.revolute(f"{prefix}wrist_{k}", con.end, piston.origin)
        m.prismatic(f"{prefix}bore_{k}", m.ground.at(0.0, foot, axis, z=place), piston.origin)
        lean = math.asin(throw / rod * math.sin(pin - axis))
        near = axis - lean
        up = at[1] + foot + rod * math.sin(near)
        m.start_near(**{con.name: math.degrees(near), piston.name: (0.0, up, math.degrees(axis))})
