"""Torsion spring by a law of the user: any function of the relative angle of two bodies and of its rate.

    T = law(theta_j - theta_i, omega_j - omega_i)        on body j, -T on body i; element TURN

A linear one is law = -k (angle - free) - c rate. As of a spring between points, all that a law gives and takes is
counted as work. Source: Haug 1989, ch. 6.2.
"""

from __future__ import annotations

from typing import Any

from mbsd.base.codes import TURN
from mbsd.model.forces.kind import Element, ForceKind, register
from mbsd.model.forces.spring_law import law_of


def _example_law(angle: Any, rate: Any) -> Any:
    return 1.0 - 5.0 * angle * angle * angle - 0.3 * rate


TORSION_SPRING_LAW = register(
    ForceKind(
        "torsion_spring_law",
        lambda force: (Element(TURN, ()),),
        interactions=law_of,
        example=lambda m, i, j: m.torsion_spring_law("example", i.body, j.body, _example_law),
        saved=False,
    )
)
