"""Quadratic drag of still or moving air, at a point of a body, and against turning.

    F = -c |w| w,   w = velocity of marker j less that of the air        c = rho c_d A / 2 (N s^2/m^2)
    T = -c_t |omega| omega                                               c_t (N m s^2)

The air moves with wind * gust(t). Nothing feels the opposite. Source: Batchelor, Fluid Dynamics, 1967, ch. 5.11.
"""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.base.arguments import number_pair
from mbsd.model.adding.forces import (
    Amount,
    add_force,
    amount_given,
    amounts_given,
)
from mbsd.model.body import Marker
from mbsd.model.force import Force, ForceKind, Interaction, register
from mbsd.model.mechanism import Model


def _interactions(force, packed):
    p = force.params
    numbers = [p["coefficient"], p["turning"], *p["wind"], p.get("gust", 0.0)]
    return (Interaction("drag", force.i, force.j, numbers, "gust" if "gust" in force.laws else None),)


DRAG = register(
    ForceKind(
        "drag",
        interactions=_interactions,
        outside=True,
        example=lambda m, i, j: m.drag("example", j, 0.7, turning=0.2, wind=(1.0, -2.0), gust=0.5),
    )
)


@DRAG.adds
def drag(
    m: Model,
    name: str,
    at: Marker,
    coefficient: float,
    turning: float = 0.0,
    wind: Sequence[float] = (0.0, 0.0),
    gust: Amount = 1.0,
) -> Force:
    """Quadratic drag at a marker: coefficient (N s^2/m^2) times the square of its speed against the air.

    ``turning`` (N m s^2) brakes the body's turning likewise; ``body.at(*body.com)`` is its centre of mass. The air
    moves with ``wind`` (m/s, world axes) times ``gust``, a constant or a law of time.
    """
    params, laws = amount_given(m, name, "gust", gust)
    params |= amounts_given(m, name, coefficient=coefficient, turning=turning)
    params["wind"] = number_pair(f"{m.name}: force '{name}': wind", wind)
    return add_force(m, DRAG, name, m.ground.origin, at, params, laws, same_body=True)
