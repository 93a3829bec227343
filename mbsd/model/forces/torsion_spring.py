"""Torsion spring and damper between two bodies.

    T = -k (theta_j - theta_i - free) - c (omega_j - omega_i)        on body j, -T on body i; element TURN

Potential energy k (theta_j - theta_i - free)^2 / 2. Each of k, c and free may be a law of time, which does work as in
a spring between points. Source: Haug 1989, ch. 6.2.
"""

from __future__ import annotations

from mbsd.base.codes import TURN
from mbsd.model.adding.forces import Amount, add_force, origins, spring_amounts
from mbsd.model.body import Body
from mbsd.model.force import Element, Force, ForceKind, register
from mbsd.model.forces.spring import constant_terms, terms_in_time
from mbsd.model.mechanism import Model

TORSION_SPRING = register(
    ForceKind(
        "torsion_spring",
        lambda force: (Element(TURN, constant_terms(force, "free_angle")),),
        interactions=lambda force, masses: terms_in_time(force, "free_angle", turning=True),
        look="spiral",
        example=lambda m, i, j: m.torsion_spring("example", i.body, j.body, 14.0, damping=0.3, free_angle=0.2),
    )
)


@TORSION_SPRING.adds
def torsion_spring(
    m: Model,
    name: str,
    first: Body | str,
    second: Body | str,
    stiffness: Amount,
    damping: Amount = 0.0,
    free_angle: Amount = 0.0,
) -> Force:
    """Add a torsion spring (N m/rad) and damper (N m s/rad) between two bodies.

    There is no torque where second - first is ``free_angle`` (rad).

    Each is a constant or a law of time.
    """
    params, laws = spring_amounts(m, name, stiffness=stiffness, damping=damping, free_angle=free_angle)
    return add_force(m, TORSION_SPRING, name, *origins(m, name, first, second), params, laws)
