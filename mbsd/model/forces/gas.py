"""Gas behind a piston: polytropic pressure against the air outside.

    F = A (p - p_air),   p = p_0 ((x_0 + c) / (x + c))^gamma        element AXIS

x is how far marker j lies along the x axis of marker i, x_0 where the pressure is p_0, c the length of the dead space.
Positive F pushes j away. Source: Heywood, Internal Combustion Engine Fundamentals, ch. 4 (polytropic compression).
"""

from __future__ import annotations

from mbsd.base.codes import AXIS, CONSTANT, POWER
from mbsd.model.forces.kind import Element, ForceKind, Term, register


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
        example=lambda m, i, j: m.gas("example", i, j, area=0.002, pressure=1.1e5, at=0.12, clearance=8.0),
    )
)
