"""Gas behind a piston over an engine's cycle: its pressure follows from volume and crank angle.

    F = A (p(phi, V) - p_out),   V = A (x - x_t + c),   phi = +-(theta_crank - theta_cylinder - fires_at)
                                                                                                        element AXIS

x is how far marker j lies along the x axis of marker i, x_t where that is at the top dead centre, c = stroke /
(compression - 1). Positive F pushes j away. p is that of a cycle, see mbsd/model/cylinders/cycle.py: polytropic in the
volume where the piston really is; the heat that a charge releases, (n - 1) int V^(n - 1) dQ, takes V where crank and
rod put it. F does work; over a cycle that is the indicated work.

Sources: Heywood, Internal Combustion Engine Fundamentals, ch. 2, 9; Ferguson, Kirkpatrick, Internal Combustion
Engines, ch. 2.
"""

from __future__ import annotations

from functools import lru_cache

from mbsd.base.codes import AXIS
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.body import Body, Marker
from mbsd.model.cylinders.cycle import Bore, GasCycle
from mbsd.model.cylinders.engine_cycles import PressureTable, four_stroke
from mbsd.model.cylinders.engine_cylinder import EngineCylinder, cylinder_of, given_motion
from mbsd.model.entries import above_zero, add_force, amounts_given
from mbsd.model.force import Chamber, CrankCycle, Element, Force, ForceKind, Interaction, Masses, register_force
from mbsd.model.mechanism import Model, own_body

PHASE = 6
"""Numbers of a phase, as mbsd/equations/interactions/gas_cycle.py reads them."""
HEAD = 10
"""Numbers before the table of phases."""


def _cylinder(force: Force, masses: Masses) -> EngineCylinder:
    try:
        return cylinder_of(force, masses.joints)
    except ModelError as error:
        raise ModelError(f"{masses.model}: {error}") from None


def _interactions(force, masses):
    p, cylinder = force.params, _cylinder(force, masses)
    bore = cylinder.bore
    count, first, table = _table(p["cycle"], bore)
    head = (
        bore.area, p["outside"], cylinder.shift, bore.bottom, cylinder.sense, cylinder.fires_at, first,
        p["cycle"].period, 0.5 * bore.motion.stroke, count,
    )  # fmt: skip
    return (Interaction("gas_cycle", force.i, force.j, (*head, *table), crank=p["crank"]),)


@lru_cache(maxsize=64)
def _table(cycle: GasCycle, bore: Bore) -> tuple[int, float, tuple[float, ...]]:
    """How many phases, where the first begins (rad), and all their numbers."""
    phases = cycle.phases(bore)
    rows: list[float] = []
    pieces: list[float] = []
    begin = HEAD + PHASE * len(phases)
    for phase in phases:
        own = phase.begin - phases[0].begin, phase.exponent, phase.to, phase.width
        rows += [*own, begin + len(pieces), len(phase.pieces)]
        for at, coefficients in zip(phase.breaks, phase.pieces, strict=False):
            pieces += [at, *coefficients]
    return len(phases), phases[0].begin, (*rows, *pieces)


def _chamber(force: Force, masses: Masses) -> Chamber:
    cylinder, cycle = _cylinder(force, masses), force.params["cycle"]
    bore = cylinder.bore
    follows = not isinstance(cycle, PressureTable)
    of_crank = CrankCycle(
        force.params["crank"],
        cylinder.fires_at,
        cylinder.sense,
        cycle.period,
        bore.area * bore.motion.stroke,
        tuple(phase.begin for phase in cycle.phases(bore)) if follows else (),
        bore.height if follows else None,
        cycle.burns,
    )
    return Chamber(bore.area, cylinder.shift, force.params["outside"], of_crank)


GAS_CYCLE = register_force(
    ForceKind(
        "gas_cycle",
        interactions=_interactions,
        along=lambda force: Element(AXIS, ()),
        chamber=_chamber,
        sign="engine cylinder",
        look="cylinder",
        example=lambda m, i, j: m.gas_cycle(
            "example", i, j, j.body, four_stroke(8.0), bore=0.08, fires_at=0.0, stroke=12.0, rod=30.0, top=-9.0
        ),
    )
)
"""A stroke so long that the piston is within it wherever the test puts it."""


@GAS_CYCLE.adds
def gas_cycle(
    m: Model,
    name: str,
    cylinder: Marker,
    piston: Marker,
    crank: str | Body,
    cycle: GasCycle,
    bore: float,
    fires_at: float | None = None,
    clockwise: bool = False,
    stroke: float | None = None,
    rod: float | None = None,
    offset: float = 0.0,
    top: float | None = None,
    outside: float = 101325.0,
) -> Force:
    """Gas of an engine between a cylinder's head and a piston, along the x axis of marker ``cylinder``.

    ``cycle``: ``four_stroke(...)``, ``two_stroke(...)`` or ``pressure_table(...)``, over the angle of the body
    ``crank`` against that of the cylinder, from ``fires_at`` on (rad), a top dead centre; a crank that turns
    ``clockwise`` goes through it the other way round. ``bore``: diameter (m); ``outside``: pressure (Pa) on the
    piston's other side, in the crankcase.

    How far the crank lets the piston down is found from the joints: of the crank (revolute), of the piston
    (prismatic) and of the rod between them, or of a rod on another's master rod, or of a pin in a slot across the
    piston. Else ``stroke`` and ``rod`` (m) tell it, with the ``offset`` of the cylinder to the left of the crank's
    axis, and ``top``, where the piston's marker lies along the axis at the top dead centre (m); without ``rod`` it
    moves as a Scotch yoke. ``fires_at`` may be left out where the joints tell the top dead centre, also of a piston
    whose head lies on the side of the crank. Else a solution raises ModelError.
    """
    what = f"force '{name}'"
    body = own_body(m, crank, f"{what}: crank")
    if not isinstance(cycle, GasCycle):
        raise ModelError(
            f"{m.name}: {what}: cycle is {shown(cycle)}; it must be four_stroke(...), two_stroke(...) or "
            "pressure_table(...)"
        )
    params = amounts_given(m, name, outside=outside)
    params |= {"crank": body.name, "cycle": cycle, "clockwise": clockwise}
    params |= above_zero(m, name, bore=bore, stroke=stroke, rod=rod)
    params |= {"fires_at": fires_at, "top": top, "offset": offset}
    if stroke is None and (rod is not None or offset != 0.0):
        raise ModelError(
            f"{m.name}: {what}: rod and offset go with stroke; give stroke= too, or leave them to the joints"
        )
    if stroke is not None:
        given_motion(f"{m.name}: {what}", stroke, rod, offset, 1.0)
    return add_force(m, GAS_CYCLE, name, cylinder, piston, params)
