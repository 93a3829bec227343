"""Bushing: springs and dampers along both axes of marker i and a torsion spring, as a rubber mount.

    F_x = -k_x x - c_x x',   F_y = -k_y y - c_y y'        x, y: place of marker j in the frame of marker i
    T   = -k_t turn - c_t turn'                           turn = theta_j - theta_i - free_angle

Elements AXIS, AXIS (turned), TURN. Source: ADAMS/Solver, BUSHING (diagonal stiffness).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mbsd.base.arguments import several_numbers
from mbsd.base.codes import AXIS, DAMPING, LINEAR, TURN
from mbsd.model.adding.forces import (
    add_force,
    amounts_given,
)
from mbsd.model.body import Marker
from mbsd.model.force import Element, Force, ForceKind, Term, register
from mbsd.model.mechanism import Model, number_given


def _elements(force):
    p = force.params

    def part(k: int, rest: float = 0.0) -> tuple[Term, Term]:
        return Term(LINEAR, p["stiffness"][k], rest), Term(DAMPING, p["damping"][k])

    return Element(AXIS, part(0)), Element(AXIS, part(1), turned=True), Element(TURN, part(2, p["free_angle"]))


BUSHING = register(
    ForceKind(
        "bushing",
        _elements,
        example=lambda m, i, j: m.bushing("example", i, j, (90.0, 140.0, 6.0), damping=(2.0, 3.0, 0.1)),
    )
)


@BUSHING.adds
def bushing(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    stiffness: Sequence[float],
    damping: Sequence[float] = (0.0, 0.0, 0.0),
    free_angle: float = 0.0,
) -> Force:
    """Springs and dampers along x and y of marker i and in turning (N/m, N/m, N m/rad), damping alike."""
    params: dict[str, Any] = {"free_angle": number_given(m, f"force '{name}': free_angle", free_angle)}
    for what, values in (("stiffness", stiffness), ("damping", damping)):
        values = several_numbers(f"{m.name}: force '{name}': {what}", values, 3, "give (x, y, turning)")
        params[what] = tuple(amounts_given(m, name, **{f"{what}[{k}]": v for k, v in enumerate(values)}).values())
    return add_force(m, BUSHING, name, i, j, params)
