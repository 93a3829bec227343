"""Torsion spring by a law of the user: any function of two bodies' relative angle and its rate.

    T = law(theta_j - theta_i, omega_j - omega_i)        on body j, -T on body i; element TURN

A linear one is law = -k (angle - free) - c rate. As of a spring between points, all that a law gives and takes is
counted as work. Source: Haug 1989, ch. 6.2.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mbsd.base.codes import TURN
from mbsd.model.adding.forces import (
    add_force,
    law_given,
    origins,
)
from mbsd.model.body import Body
from mbsd.model.force import Element, Force, ForceKind, register
from mbsd.model.forces.spring_law import law_of
from mbsd.model.mechanism import Model


def _example_law(angle: Any, rate: Any) -> Any:
    return 1.0 - 5.0 * angle * angle * angle - 0.3 * rate


TORSION_SPRING_LAW = register(
    ForceKind(
        "torsion_spring_law",
        lambda force: (Element(TURN, ()),),
        interactions=law_of,
        look="spiral",
        example=lambda m, i, j: m.torsion_spring_law("example", i.body, j.body, _example_law),
        saved=False,
    )
)


@TORSION_SPRING_LAW.adds
def torsion_spring_law(
    m: Model, name: str, first: Body | str, second: Body | str, law: Callable[[float, float], float]
) -> Force:
    """Add a torsion spring by any function ``law(angle, rate)``, which gives the torque on ``second``.

    Units are rad, rad/s and N m.

    The angle is that of second against first: ``lambda angle, rate: -k * angle - c * rate`` is a linear one.
    """
    params = law_given(m, name, law, "the angle and its rate")
    return add_force(m, TORSION_SPRING_LAW, name, *origins(m, name, first, second), params)
