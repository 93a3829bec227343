"""Double-acting cylinder: gas in two chambers, let in and out by a valve's travel; its pressures are states.

    F   = p_a A_a - p_b A_b - p_out (A_a - A_b)               A_a = pi d^2 / 4,  A_b = pi (d^2 - d_r^2) / 4
    V_a = D_a + A_a x,   V_b = D_b + A_b (S - x)              x: place of the piston's marker along the cylinder's axis
    p'  = n / V (w - p V'),   w = C b (e Q(p_s, p) + o Q(p_e, p))          of each chamber
    e   = opening of the port to the supply, s - lap;   o = to the exhaust, -s - exhaust_lap;   0 .. port
    Q(p_1, p_2) = p_1 sqrt(2 n / (n - 1) (r^(2/n) - r^((n+1)/n))),   r = p_2 / p_1, at least the critical ratio

s is the valve's travel from its middle, the coordinate of its prismatic joint on the cylinder's body: for chamber b it
counts the other way. b is the width of the ports, C = discharge sqrt(R T). The gas is ideal, of one temperature in all
ports; with closed ports p V^n stays. Edges are round, so a port opens smoothly over the first fiftieth of its width.
Where nearly no pressure is lost, the flow is laminar. Positive F pushes the piston along the x axis of the cylinder's
marker, away from chamber a.

Sources: Heywood, Internal Combustion Engine Fundamentals, app. C (flow through valves); Ripper, Steam Engine Theory
and Practice, 1908, ch. 6 and 10 (lap, lead, cut-off, indicator diagrams).
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from mbsd.base.codes import AXIS
from mbsd.base.errors import ModelError
from mbsd.model.body import Marker
from mbsd.model.entries import above_zero, add_force, amounts_given
from mbsd.model.force import Element, Force, ForceKind, Interaction, Masses, States, Valved, register_force
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model, number_given, own_joint

DEAD = 0.05
"""Dead volume of a chamber by default, as a part of what the piston sweeps."""
CLEAR = 1e-9
"""Part of the stroke by which the piston may be beyond an end."""


def _areas(force: Force) -> tuple[float, float]:
    """Return areas of the piston in chambers a and b (m^2)."""
    p = force.params
    return math.pi / 4 * p["bore"] ** 2, math.pi / 4 * (p["bore"] ** 2 - p["rod"] ** 2)


def volumes(force: Force, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return volumes of both chambers (m^3) at places x (T,) of the piston (m)."""
    p, (a, b) = force.params, _areas(force)
    dead_a, dead_b = (
        DEAD * area * p["stroke"] if p[key] is None else p[key] for key, area in (("dead_a", a), ("dead_b", b))
    )
    return dead_a + a * x, dead_b + b * (p["stroke"] - x)


def _valve(force: Force, masses: Masses) -> tuple[str, float, float, float]:
    """Return the valve's body, and two factors and a sum that give its travel from its place."""
    joint = next((joint for joint in masses.joints if joint.name == force.params["valve"]), None)
    if joint is None or joint.i.body.name != force.i.body.name:
        raise ModelError(
            f"{masses.model}: force '{force.name}': joint '{force.params['valve']}' of its valve is gone; give valve= "
            "the name of another"
        )
    com = masses.com[list(masses.names).index(joint.j.body.name)]
    turned, own, seat = joint.i.angle - force.i.angle, joint.j, joint.i
    c, s = math.cos(turned), math.sin(turned)
    ahead = math.cos(own.angle) * (own.x - com[0]) + math.sin(own.angle) * (own.y - com[1])
    dx, dy, axis = seat.x - force.i.x, seat.y - force.i.y, force.i.angle + turned
    begin = math.cos(axis) * dx + math.sin(axis) * dy
    return joint.j.body.name, c, s, float(ahead) - begin - force.params["middle"]


def _interactions(force, masses):
    p, (area_a, area_b) = force.params, _areas(force)
    dead_a, dead_b = volumes(force, np.zeros(1))[0][0], volumes(force, np.full(1, p["stroke"]))[1][0]
    body, along, across, begin = _valve(force, masses)
    sense = -1.0 if p["inside"] else 1.0
    numbers = (
        _one(force) / masses.size, area_a, area_b, p["stroke"], float(dead_a), float(dead_b), p["supply"], p["exhaust"],
        p["outside"], p["exponent"], p["discharge"] * math.sqrt(p["gas_constant"] * p["temperature"]), p["width"],
        p["lap"], p["exhaust_lap"], p["port"], sense * along, sense * across, sense * begin,
    )  # fmt: skip
    return (Interaction("double_acting_cylinder", force.i, force.j, numbers, crank=body, with_states=True),)


def _one(force: Force) -> float:
    return force.params["supply"]


def _start(
    model: str, force: Force, laws: Mapping[str, float], x: float, rate: float, effort: float
) -> tuple[float, float]:
    p = force.params
    _refuse_beyond(model, force, np.zeros(1), np.array([x]))
    given = p["pressure_a"], p["pressure_b"]
    return tuple(p["exhaust"] if pressure is None else pressure for pressure in given)  # pyright: ignore[reportReturnType]


def _refuse_beyond(model: str, force: Force, times: np.ndarray, x: np.ndarray) -> None:
    """Raise ModelError where the piston is beyond an end of its cylinder."""
    stroke = force.params["stroke"]
    beyond = np.maximum(-x, x - stroke)
    k = int(beyond.argmax())
    if not beyond[k] <= CLEAR * stroke:
        raise ModelError(
            f"{model}: force '{force.name}': at t = {times[k]:.6g} s the piston lies {x[k]:.6g} m along its cylinder, "
            f"of which 0 .. {stroke:.6g} m are its stroke. Move its marker, or correct stroke="
        )


def _check(model: str, force: Force, times: np.ndarray, x: np.ndarray, states: np.ndarray) -> None:
    _refuse_beyond(model, force, times, x)


def _example(m, i, j):
    body = m.body("valve of example", mass=0.1, inertia=0.1)
    m.prismatic("seat of example", i.body.at(0.1, 0.4), body.origin)
    start = i.body.at(i.x - 5.0 * math.cos(i.angle), i.y - 5.0 * math.sin(i.angle), i.angle)
    m.double_acting_cylinder(
        "example", start, j, bore=0.1, stroke=9.0, valve="seat of example", supply=8e4, width=0.02, lap=0.01, port=0.3,
        rod=0.05, exhaust=1e4, outside=0.0, dead_a=0.5, dead_b=0.5, pressure_a=3e4, pressure_b=2e4,
    )  # fmt: skip


DOUBLE_ACTING_CYLINDER = register_force(
    ForceKind(
        "double_acting_cylinder",
        interactions=_interactions,
        along=lambda force: Element(AXIS, ()),
        states=States(("pressure_a", "pressure_b"), "Pa", _one, _start, _check),
        valved=Valved(volumes, _valve),
        sign="double acting",
        look="cylinder",
        example=_example,
    )
)


@DOUBLE_ACTING_CYLINDER.adds
def double_acting_cylinder(
    m: Model,
    name: str,
    cylinder: Marker,
    piston: Marker,
    bore: float,
    stroke: float,
    valve: Joint | str,
    supply: float,
    width: float,
    lap: float = 0.0,
    exhaust_lap: float = 0.0,
    port: float = 1.0,
    rod: float = 0.0,
    exhaust: float = 101325.0,
    inside: bool = False,
    middle: float = 0.0,
    exponent: float = 1.3,
    temperature: float = 450.0,
    gas_constant: float = 461.5,
    discharge: float = 0.7,
    dead_a: float | None = None,
    dead_b: float | None = None,
    pressure_a: float | None = None,
    pressure_b: float | None = None,
    outside: float = 101325.0,
) -> Force:
    """Add a cylinder with steam or air on both sides of its piston, and a slide valve; pressures are absolute (Pa).

    The piston's marker moves from 0 to ``stroke`` (m) along the x axis of marker ``cylinder``, away from chamber a; the
    piston ``rod`` goes through chamber b. ``bore``, ``rod``: diameters (m). ``valve``: the prismatic joint on the
    cylinder's body in which the valve slides. Its travel from ``middle`` (m) beyond ``lap`` leads the ``supply`` into
    chamber a, and beyond ``exhaust_lap`` chamber b to the ``exhaust``; the other way round below. With ``inside``, as
    of piston valves, a travel towards less does so. Ports are ``width`` (m) wide and open by ``port`` (m) at most.

    The gas has ``exponent``, ``temperature`` (K, in the ports) and ``gas_constant`` (J/kg/K), by default those of
    steam. ``dead_a``, ``dead_b``: volumes (m^3) beside the swept ones, by default a twentieth of these. Pressures begin
    at that of the exhaust unless ``pressure_a`` and ``pressure_b`` are given; a motion needs a turn to forget them.
    """
    what = f"{m.name}: force '{name}'"
    joint = own_joint(m, valve, f"force '{name}': valve")
    if joint.kind.pair != "guide" or joint.i.body is not cylinder.body:
        raise ModelError(
            f"{what}: valve is '{joint.name}', a {joint.kind.name} on '{joint.i.body.name}'; give a prismatic joint "
            f"whose first marker is on '{cylinder.body.name}', the cylinder's body"
        )
    params = amounts_given(m, name, lap=lap, exhaust_lap=exhaust_lap, rod=rod, exhaust=exhaust, outside=outside)
    params |= above_zero(
        m, name, bore=bore, stroke=stroke, supply=supply, width=width, port=port, temperature=temperature,
        gas_constant=gas_constant, discharge=discharge, dead_a=dead_a, dead_b=dead_b, pressure_a=pressure_a,
        pressure_b=pressure_b,
    )  # fmt: skip
    if not rod < bore:
        raise ModelError(f"{what}: rod is {rod:g} m, but the bore only {bore:g} m; the rod is inside of the bore")
    if not exhaust < supply:
        raise ModelError(
            f"{what}: the exhaust has {exhaust:g} Pa and the supply {supply:g} Pa. Both are absolute, in pascals (10 "
            "bar are 1e6); make the supply's the higher one"
        )
    if not exponent > 1.0:
        raise ModelError(f"{what}: exponent is {exponent:g}; it must be above 1, as 1.3 of steam or 1.4 of air")
    params |= {"exponent": exponent, "middle": number_given(m, f"force '{name}': middle", middle)}
    params |= {"valve": joint.name, "inside": bool(inside)}
    return add_force(m, DOUBLE_ACTING_CYLINDER, name, cylinder, piston, params)
