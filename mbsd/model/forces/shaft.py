"""Shaft that yields in torsion between two bodies about its axis, as of a rotor and its flywheel.

    T = -k (theta_j - theta_i - free) - c (omega_j - omega_i)      on body j, -T on body i; element TURN
    k = G pi (D^4 - d^4) / (32 L)                                   D: diameter, d: bore, G: shear modulus

A torsion spring by the shaft's own sizes, so that these may vary; its mass counts with the bodies. Potential energy
k (theta_j - theta_i - free)^2 / 2. Pins hold the bodies: a shaft bends in no way here. Several pieces in a row, of
bodies between them, have stiffnesses that add up as 1 / k does.

Source: Saint-Venant; Timoshenko, Strength of Materials I, ch. 10.
"""

from __future__ import annotations

import math
from typing import Any

from mbsd.base.codes import DAMPING, LINEAR, TURN
from mbsd.base.errors import ModelError
from mbsd.model.adding.forces import above_zero, add_force, amounts_given, origins
from mbsd.model.body import Body
from mbsd.model.force import Element, Force, ForceKind, Term, register
from mbsd.model.mechanism import Model, number_given


def _elements(force):
    p = force.params
    stiffness = p["shear_modulus"] * math.pi * (p["diameter"] ** 4 - p["bore"] ** 4) / (32.0 * p["length"])
    return (Element(TURN, (Term(LINEAR, stiffness, p["free_angle"]), Term(DAMPING, p["damping"]))),)


SHAFT = register(
    ForceKind(
        "shaft",
        _elements,
        example=lambda m, i, j: m.shaft(
            "example", i.body, j.body, 2.0, 0.3, shear_modulus=4e4, bore=0.1, damping=0.3, free_angle=0.2
        ),
    )
)


@SHAFT.adds
def shaft(
    m: Model,
    name: str,
    first: Body | str,
    second: Body | str,
    length: float,
    diameter: float,
    shear_modulus: float = 79.3e9,
    bore: float = 0.0,
    damping: float = 0.0,
    free_angle: float = 0.0,
) -> Force:
    """Add a shaft that twists between two bodies, by length, diameter (m) and ``shear_modulus`` (Pa).

    A ``bore`` (m) makes it hollow. ``damping`` in N m s/rad; no torque where second - first is ``free_angle`` (rad).
    The shear modulus is that of steel unless given.
    """
    params: dict[str, Any] = {
        "length": above_zero(m, name, "length", length),
        "diameter": above_zero(m, name, "diameter", diameter),
        "shear_modulus": above_zero(m, name, "shear_modulus", shear_modulus),
        "free_angle": number_given(m, f"force '{name}': free_angle", free_angle),
        **amounts_given(m, name, bore=bore, damping=damping),
    }
    if params["bore"] >= params["diameter"]:
        raise ModelError(
            f"{m.name}: force '{name}': bore is {bore:g} m in a shaft of {diameter:g} m diameter; it must be smaller"
        )
    return add_force(m, SHAFT, name, *origins(m, name, first, second), params)
