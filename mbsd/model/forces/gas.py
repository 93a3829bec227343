"""Gas behind a piston: polytropic pressure against the air outside.

    F = A (p - p_air),   p = p_0 ((x_0 + c) / (x + c))^gamma        element AXIS

x is how far marker j lies along the x axis of marker i, x_0 where the pressure is p_0, c the length of the dead space.
Positive F pushes j away. Source: Heywood, Internal Combustion Engine Fundamentals, ch. 4 (polytropic compression).
"""

from __future__ import annotations

from mbsd.base.codes import AXIS, CONSTANT, POWER
from mbsd.base.errors import ModelError
from mbsd.model.adding.forces import (
    add_force,
    amounts_given,
)
from mbsd.model.body import Marker
from mbsd.model.chamber import Chamber
from mbsd.model.force import Element, Force, ForceKind, Term, register
from mbsd.model.mechanism import Model, number_given


def _elements(force):
    p = force.params
    gamma = p["exponent"]
    factor = p["area"] * p["pressure"] * (p["at"] + p["clearance"]) ** gamma
    terms = Term(POWER, factor, p["clearance"], -gamma), Term(CONSTANT, -p["area"] * p["outside"])
    return (Element(AXIS, terms),)


GAS = register(
    ForceKind(
        "gas",
        _elements,
        chamber=lambda force, masses: Chamber(*(force.params[key] for key in ("area", "clearance", "outside"))),
        look="cylinder",
        example=lambda m, i, j: m.gas("example", i, j, area=0.002, pressure=1.1e5, at=0.12, clearance=8.0),
    )
)


@GAS.adds
def gas(
    m: Model,
    name: str,
    cylinder: Marker,
    piston: Marker,
    area: float,
    pressure: float,
    at: float,
    clearance: float = 0.0,
    exponent: float = 1.3,
    outside: float = 101325.0,
) -> Force:
    """Gas between a cylinder's head and a piston, along the x axis of marker ``cylinder``.

    ``pressure`` (Pa, absolute) where the piston lies ``at`` (m) along that axis; ``clearance`` (m) is the length
    of the dead space before 0; ``outside`` is the pressure on the piston's other side.
    """
    params = amounts_given(
        m, name, area=area, pressure=pressure, clearance=clearance, exponent=exponent, outside=outside
    )
    params["at"] = number_given(m, f"force '{name}': at", at)
    if params["at"] + params["clearance"] <= 0:
        raise ModelError(f"{m.name}: force '{name}': at + clearance is {at + clearance:g} m; it must be positive")
    return add_force(m, GAS, name, cylinder, piston, params)
