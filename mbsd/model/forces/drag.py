"""Quadratic drag of still or moving air, at a point of a body, and against turning.

    F = -c |w| w,   w = velocity of marker j less that of the air        c = rho c_d A / 2 (N s^2/m^2)
    T = -c_t |omega| omega                                               c_t (N m s^2)

The air moves with wind * gust(t). Nothing feels the opposite. Source: Batchelor, Fluid Dynamics, 1967, ch. 5.11.
"""

from __future__ import annotations

from mbsd.model.forces.kind import ForceKind, Interaction, register


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
