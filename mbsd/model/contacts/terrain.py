"""Contact of a point or disc with a terrain: a smooth curve through points, solid on its right.

    g = n . (p_j - c(u)) - r        constraint `curve`; c(u): the curve's point nearest to p_j
    s = arc + r (a - beta)          constraint `curve_rolling`; arc length and tangent angle beta at c(u)

N pushes marker j to the left of the curve. Beyond its ends an open curve goes on straight. A disc touches where the
curve is nearest to its centre, at one point; the model refuses discs that bends of the curve are too tight for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from mbsd.model.adding.contacts import add_contact, amounts_given, frictions_given
from mbsd.model.body import Marker
from mbsd.model.contact import ContactKind, register
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model

if TYPE_CHECKING:
    import numpy as np


def _numbers(params: Mapping[str, Any]) -> list[np.ndarray]:
    from mbsd.model.plane_curves import disc_numbers

    return disc_numbers(params, follows=False)


TERRAIN = register(
    ContactKind(
        "rigid_terrain",
        ("curve", "curve_rolling"),
        example=lambda m, i, j: m.rigid_terrain(
            "example", i, j, [(-6, -3), (-4, -2.5), (-2, -2), (0, -2.3), (2, -2.5), (4, -1.8), (6, -1.9)], radius=0.2
        ),
        numbers=_numbers,
        lengths=("radius", "points"),
        touching="curve",
    )
)


@TERRAIN.adds
def rigid_terrain(
    m: Model,
    name: str,
    terrain: Marker,
    point: Marker,
    points: Sequence[Sequence[float]],
    radius: float = 0.0,
    closed: bool = False,
    restitution: float = 0.0,
    friction: float = 0.0,
    static_friction: float | None = None,
) -> Joint:
    """A point, or a disc of ``radius`` (m) around it, stays on the left of a smooth curve.

    It goes through ``points`` (k, 2) in the axes of marker ``terrain`` (m), for a ground from left to right; beyond
    its ends an open curve goes on straight. A ``closed`` one is solid within where its points go clockwise, so that
    what touches it stays outside, and solid outside where they go counter-clockwise.
    """
    from mbsd.model.plane_curves import checked_points, refuse_crossing, refuse_tight

    what = f"{m.name}: contact '{name}'"
    params = amounts_given(m, name, radius=radius) | frictions_given(m, name, friction, static_friction)
    plain = checked_points(what, points, closed)
    refuse_crossing(what, plain, closed)
    refuse_tight(what, plain, closed, params["radius"])
    params |= {"points": plain, "closed": bool(closed)}
    return add_contact(m, TERRAIN, name, terrain, point, restitution, params)
