"""Spring and damper between two points.

    F = -k (l - l0) - c l'        l = |p_j - p_i|, element LINE

Positive F pushes the points apart; a stretched spring pulls them together. Potential energy k (l - l0)^2 / 2.
Each of k, c and l0 may be a law of time. What a law changes has no potential and does work: all of a spring with k(t),
k l0(t) of one with l0(t). Source: Haug 1989, ch. 6.2.
"""

from __future__ import annotations

from mbsd.base.codes import DAMPER, DAMPING, FREE, LINE, LINEAR, STIFFNESS
from mbsd.model.adding.forces import (
    Amount,
    add_force,
    spring_amounts,
)
from mbsd.model.body import Marker
from mbsd.model.force import Element, Force, ForceKind, Interaction, Term, register
from mbsd.model.mechanism import Model


def constant_terms(force: Force, free: str) -> tuple[Term, Term]:
    """Return the terms of a spring, linear or torsional, without laws; ``free`` names its free value."""
    p = force.params
    return Term(LINEAR, p.get("stiffness", 0.0), p.get(free, 0.0)), Term(DAMPING, p.get("damping", 0.0))


def terms_in_time(force: Force, free: str, turning: bool) -> tuple[Interaction, ...]:
    """One interaction for each number that is a law."""
    p = force.params
    own = {
        "stiffness": (STIFFNESS, p.get(free, 0.0)),
        "damping": (DAMPER, 0.0),
        free: (FREE, p.get("stiffness", 0.0)),
    }
    return tuple(
        Interaction("spring_in_time", force.i, force.j, [*own[name], float(turning)], name) for name in force.laws
    )


SPRING = register(
    ForceKind(
        "spring",
        lambda force: (Element(LINE, constant_terms(force, "free_length")),),
        interactions=lambda force, masses: terms_in_time(force, "free_length", turning=False),
        look="coil",
        example=lambda m, i, j: m.spring("example", i, j, 120.0, damping=3.0, free_length=0.4),
    )
)


@SPRING.adds
def spring(
    m: Model, name: str, i: Marker, j: Marker, stiffness: Amount, damping: Amount = 0.0, free_length: Amount = 0.0
) -> Force:
    """Spring (N/m) and damper (N s/m) between the points of two markers; ``free_length`` in m.

    Each is a constant or a law of time.
    """
    params, laws = spring_amounts(m, name, stiffness=stiffness, damping=damping, free_length=free_length)
    return add_force(m, SPRING, name, i, j, params, laws)
