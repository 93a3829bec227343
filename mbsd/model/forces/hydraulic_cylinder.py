"""Hydraulic cylinder: two chambers of oil, a valve and a supply; its pressures are states.

    F = p_a A_a - p_b A_b - p_out (A_a - A_b) - F_R tanh(l' / v_0) + stops
    A_a = pi d^2 / 4,  A_b = pi (d^2 - d_r^2) / 4
    p_a' = E / V_a (Q_a - A_a l' - g (p_a - p_b)),   p_b' = E / V_b (Q_b + A_b l' + g (p_a - p_b))
    stops   -k e (1 + z l') where the rod is out by more than its stroke,  k e (1 - z l') where it is in beyond its end,
            e: how far beyond, never pulling back

Volumes, flows of the valve and the bulk modulus are in mbsd/model/oil_cylinder.py with their sources. Chamber
A is that of the whole piston: an opening u > 0 leads the supply into it and chamber B to the tank, so that the points
are pushed apart. Positive F pushes them apart.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from mbsd.base.codes import LINE
from mbsd.base.errors import ModelError, ModelWarning, SimulationError
from mbsd.base.quantity import written
from mbsd.base.warning import warn
from mbsd.model.body import Marker
from mbsd.model.entries import Amount, above_zero, add_force, amount_given, amounts_given
from mbsd.model.force import Element, Force, ForceKind, Interaction, Masses, States, marker_place, register_force
from mbsd.model.mechanism import Model
from mbsd.model.oil_cylinder import ATMOSPHERE, LEAST, OilCylinder

DEAD = 0.05
"""Part of a swept volume that is dead where nobody says how much is."""
STOP = 1e-3
"""Part of the stroke by which the supply presses a stop in whose stiffness nobody gave."""
CAVITATES = 1e4
"""Absolute pressure (Pa) below which oil gives off the air that it holds."""
BELOW = 1e-6
"""Part of the supply pressure by which integration may pass zero."""
SPENT = 1e-9
"""Part of the stroke by which a start may miss the cylinder's ends."""


def _oil(force: Force) -> OilCylinder:
    p = force.params
    area_a = math.pi * p["bore"] ** 2 / 4
    area_b = math.pi * (p["bore"] ** 2 - p["rod"] ** 2) / 4
    if p["orifice"] is None:
        drop, transition = p["rated_drop"], p["transition"]
        conductance = p["rated_flow"] * (drop**2 + transition**2) ** 0.25 / drop
    else:
        conductance = p["orifice"] * math.sqrt(2.0 / p["density"])
    return OilCylinder(
        area_a=area_a,
        area_b=area_b,
        retracted=p["retracted"],
        stroke=p["stroke"],
        dead_a=DEAD * area_a * p["stroke"] if p["dead_a"] is None else p["dead_a"],
        dead_b=DEAD * area_b * p["stroke"] if p["dead_b"] is None else p["dead_b"],
        bulk_modulus=p["bulk_modulus"],
        air=p["air"],
        supply=p["supply"],
        tank=p["tank"],
        conductance=conductance,
        transition=p["transition"],
        leakage=p["leak"],
        outside=p["outside"],
        pressure_a=p["pressure_a"],
        pressure_b=p["pressure_b"],
    )


def _stop_stiffness(force: Force) -> float:
    p = force.params
    given = p["stop_stiffness"]
    return p["supply"] * _oil(force).area_a / (STOP * p["stroke"]) if given is None else given


def _interactions(force, masses):
    p, oil = force.params, _oil(force)
    numbers = (
        _one(force) / masses.size, p.get("valve", 0.0), oil.area_a, oil.area_b, oil.retracted, oil.stroke,
        oil.dead_a, oil.dead_b, 1.0 / oil.bulk_modulus, oil.air * ATMOSPHERE, LEAST, oil.supply, oil.tank,
        oil.conductance, oil.transition, oil.leakage, oil.outside, p["friction"], p["slip_speed"],
        _stop_stiffness(force), p["stop_damping"],
    )  # fmt: skip
    law = "valve" if "valve" in force.laws else None
    return (Interaction("hydraulic_cylinder", force.i, force.j, numbers, law, with_states=True),)


def _potential(force: Force, masses: Masses, q: np.ndarray) -> np.ndarray:
    """Potential of the stops; oil takes and gives by its pressures, which do not follow from the pose."""
    oil = _oil(force)
    gap = marker_place(force.j, masses, q) - marker_place(force.i, masses, q)
    out_by = np.hypot(gap[:, 0], gap[:, 1]) - oil.retracted
    beyond = np.maximum(np.maximum(out_by - oil.stroke, -out_by), 0.0)
    return 0.5 * _stop_stiffness(force) * beyond**2


def _one(force: Force) -> float:
    return force.params["supply"]


def _start(
    model: str, force: Force, laws: Mapping[str, float], length: float, rate: float, effort: float
) -> tuple[float, float]:
    oil = _oil(force)
    if not -SPENT * oil.stroke <= length - oil.retracted <= (1.0 + SPENT) * oil.stroke:
        raise ModelError(
            f"{model}: force '{force.name}': its points are {length:.6g} m apart at the start; with a stroke of "
            f"{oil.stroke:g} m they are {oil.retracted:g} .. {oil.retracted + oil.stroke:g} m apart. Correct "
            "retracted= or stroke=, or start_near"
        )
    return oil.steady(laws.get("valve", force.params.get("valve", 0.0)), rate, effort)


def _check(model: str, force: Force, times: np.ndarray, length: np.ndarray, states: np.ndarray) -> None:
    oil, what = _oil(force), f"{model}: force '{force.name}'"
    for name, volume in zip("AB", oil.volumes(length), strict=True):
        k = int(volume.argmin())
        if not volume[k] > 0.0:
            raise ModelError(
                f"{what}: at t = {times[k]:.6g} s its points are {length[k]:.6g} m apart, and chamber {name} has no "
                f"volume left ({volume[k]:.3g} m^3): they can be {oil.retracted:.6g} .. "
                f"{oil.retracted + oil.stroke:.6g} m apart. Correct retracted= or stroke=, stop the motion before, "
                "or make its stops stiffer"
            )
    for name, pressure in zip("AB", states.T, strict=True):
        k = int(pressure.argmin())
        if not pressure[k] >= -BELOW * oil.supply:
            where = f"{what}: at t = {times[k]:.6g} s the pressure in chamber {name} is {written(pressure[k], 'Pa', 4)}"
            if oil.air > 0.0:
                raise SimulationError(
                    f"{where}: the steps are too long for its oil. Take method='radau' or 'dop853', or a smaller step"
                )
            raise ModelError(
                f"{where}: it becomes negative, where real oil cavitates. Give air=0.005, whose bubbles keep the "
                "pressure above zero, let oil in faster (rated_flow, orifice, valve, tank), or pull less"
            )
        if pressure[k] < CAVITATES:
            warn(
                f"{what}: at t = {times[k]:.6g} s the pressure in chamber {name} is {written(pressure[k], 'Pa', 4)}: "
                "the oil cavitates, and its bubbles carry what is pulled. Let oil in faster (rated_flow, orifice, "
                "valve, tank), or pull less",
                ModelWarning,
            )


HYDRAULIC_CYLINDER = register_force(
    ForceKind(
        "hydraulic_cylinder",
        interactions=_interactions,
        potential=_potential,
        along=lambda force: Element(LINE, ()),
        states=States(("pressure_a", "pressure_b"), "Pa", _one, _start, _check),
        oil=_oil,
        sign="strut",
        look="cylinder",
        example=lambda m, i, j: m.hydraulic_cylinder(
            "example", i, j, bore=0.1, rod=0.06, stroke=6.0, retracted=0.05, supply=3e4, valve=0.3, rated_flow=1e-2,
            tank=1e3, leak=1e-9, outside=0.0, friction=40.0, slip_speed=2.0, stop_stiffness=800.0, stop_damping=0.1,
            dead_a=0.5, dead_b=0.5, pressure_a=2e4, pressure_b=1.5e4,
        ),
    )
)  # fmt: skip


@HYDRAULIC_CYLINDER.adds
def hydraulic_cylinder(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    bore: float,
    rod: float,
    stroke: float,
    retracted: float,
    supply: float,
    valve: Amount = 0.0,
    rated_flow: float | None = None,
    rated_drop: float = 3.5e6,
    orifice: float | None = None,
    density: float = 860.0,
    tank: float = ATMOSPHERE,
    bulk_modulus: float = 1.4e9,
    air: float = 0.005,
    leak: float = 0.0,
    dead_a: float | None = None,
    dead_b: float | None = None,
    transition: float = 1e5,
    pressure_a: float | None = None,
    pressure_b: float | None = None,
    outside: float = ATMOSPHERE,
    friction: float = 0.0,
    slip_speed: float = 1e-3,
    stop_stiffness: float | None = None,
    stop_damping: float = 1.0,
) -> Force:
    """Add a hydraulic cylinder between two points; pressures are absolute (Pa) and results of the motion.

    The points are ``retracted`` (m) apart with the rod fully in, and by ``stroke`` more with it fully out.

    ``bore`` and ``rod``: diameters (m). ``valve``: its opening, a number or a law of time; 1 leads the pressure
    ``supply`` fully into the chamber of the whole piston and the other chamber to the ``tank``, -1 the other way
    round, 0 is closed, and beyond 1 no valve opens further. It lets ``rated_flow`` (m^3/s) through at a pressure drop
    ``rated_drop`` over each of its edges, or has an ``orifice`` of this area times coefficient of discharge (m^2) for
    oil of ``density`` (kg/m^3); below the drop ``transition`` the flow is laminar. ``leak``: past the piston
    (m^3/s/Pa). ``dead_a``, ``dead_b``: volumes (m^3) beside what the piston sweeps, of hoses, too; a twentieth of that
    by default.

    ``air``: part of the volume that is free air at 101325 Pa; its bubbles make the oil soft at low pressure and keep it
    above zero, and a motion in which it cavitates is warned of. Without air, a motion in which a pressure falls below
    zero raises ModelError. Pressures at the start are those of a steady flow, and behind a closed valve those that
    carry the load, unless ``pressure_a`` and ``pressure_b`` are given. ``outside``: pressure around the rod.
    ``friction`` (N) is reached at some ``slip_speed`` (m/s). Beyond both ends stops push back, as those of
    :meth:`gas_strut`; by default the supply presses them in by a thousandth of the stroke.
    """
    params = amounts_given(
        m, name, rod=rod, air=air, leak=leak, tank=tank, outside=outside, friction=friction, stop_damping=stop_damping
    )
    params |= above_zero(
        m, name, bore=bore, stroke=stroke, retracted=retracted, supply=supply, rated_drop=rated_drop, density=density,
        bulk_modulus=bulk_modulus, transition=transition, slip_speed=slip_speed, rated_flow=rated_flow, orifice=orifice,
        dead_a=dead_a, dead_b=dead_b, pressure_a=pressure_a, pressure_b=pressure_b, stop_stiffness=stop_stiffness,
    )  # fmt: skip
    what = f"{m.name}: force '{name}'"
    if not rod < bore:
        raise ModelError(f"{what}: rod is {rod:g} m, but the bore only {bore:g} m; the rod is inside of the bore")
    if (rated_flow is None) == (orifice is None):
        has = "neither rated_flow nor orifice" if orifice is None else "a rated_flow and an orifice"
        raise ModelError(
            f"{what}: the valve has {has}; give rated_flow (m^3/s at rated_drop), or orifice, its coefficient of "
            "discharge times its area (m^2)"
        )
    if not tank < supply:
        raise ModelError(
            f"{what}: the pressure of the tank is {tank:g} Pa and that of the supply {supply:g} Pa. Both are absolute, "
            "in pascals (200 bar are 2e7); make the supply's the higher one"
        )
    if not air < 1.0:
        raise ModelError(f"{what}: air is {air:g}; it is a part of the volume, say 0.005")
    own, laws = amount_given(m, name, "valve", valve)
    if own and not -1.0 <= own["valve"] <= 1.0:
        raise ModelError(f"{what}: valve is {own['valve']:g}; its opening is -1 .. 1")
    params |= own
    return add_force(m, HYDRAULIC_CYLINDER, name, i, j, params, laws)
