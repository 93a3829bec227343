"""Bushing: springs and dampers along both axes of marker i, and a torsion spring, as of a rubber mount.

    F_x = -k_x x - c_x x',   F_y = -k_y y - c_y y'        x, y: place of marker j in the frame of marker i
    T   = -k_t turn - c_t turn'                           turn = theta_j - theta_i - free_angle

Elements AXIS, AXIS (turned), TURN. Source: ADAMS/Solver, BUSHING (diagonal stiffness).
"""

from __future__ import annotations

from mbsd.base.codes import AXIS, DAMPING, LINEAR, TURN
from mbsd.model.forces.kind import Element, ForceKind, Term, register


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
