"""Spring by a law of the user: any function of the distance of two points and of its rate.

    F = law(l, l')        l = |p_j - p_i|, element LINE

Positive F pushes the points apart, as in every spring: a linear one is law = -k (l - l0) - c l'. A law has no potential
energy that the program knows: all that it gives and takes is counted as work, that of an elastic part too. A function
compiled with numba.njit is compiled in. Source: Haug 1989, ch. 6.2.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mbsd.base.codes import LINE, TURN
from mbsd.model.adding.forces import add_force, law_given
from mbsd.model.body import Marker
from mbsd.model.force import Element, Force, ForceKind, Interaction, register
from mbsd.model.mechanism import Model


def law_of(force: Any, masses: Any) -> tuple[Interaction, ...]:
    """The law between points, or between bodies where the force measures an angle."""
    turning = force.kind.elements(force)[0].kind == TURN
    return (Interaction("spring_law", force.i, force.j, (float(turning),), calls_law=True),)


def _example_law(length: Any, rate: Any) -> Any:
    return 3.0 - 2.0 * length * length - 0.4 * rate * abs(rate)


SPRING_LAW = register(
    ForceKind(
        "spring_law",
        lambda force: (Element(LINE, ()),),
        interactions=law_of,
        look="coil",
        example=lambda m, i, j: m.spring_law("example", i, j, _example_law),
        saved=False,
    )
)
"""The element measures; its size comes from the interaction."""


@SPRING_LAW.adds
def spring_law(m: Model, name: str, i: Marker, j: Marker, law: Callable[[float, float], float]) -> Force:
    """Add a spring between two markers by any function ``law(length, rate)`` (m, m/s) that gives N.

    Positive pushes the points apart: ``lambda length, rate: -k * (length - free) - c * rate`` is a linear spring
    and damper. Python or compiled with numba.njit. What it gives counts as work, not as potential energy.
    """
    return add_force(m, SPRING_LAW, name, i, j, law_given(m, name, law, "the length and its rate"))
