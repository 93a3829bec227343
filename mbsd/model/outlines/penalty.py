"""Outlines that push each other by penalty.

    depth  d = -g of each pair of a run and a feature    see mbsd/equations/relative/outline_features.py
    normal N = k d^n (1 + c d'), never below 0           k: N/m^n, n: 1 linear, 1.5 Hertz, c: s/m
    along  T = -mu N tanh(s' / s_0)                      s': sliding speed of the run at the foot

as in mbsd/model/forces/contact.py. A corner that is in an edge, and a flat side with both its corners, push with one
pair each. Depths should stay small against the bodies: the nearest edge pushes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mbsd.model.body import Body, Marker
from mbsd.model.entries import above_zero, add_force, amounts_given, exponent_given
from mbsd.model.force import Force, ForceKind, Interaction, register_force
from mbsd.model.mechanism import Model, connections, new_name
from mbsd.model.outlines.contact import check_two_bodies, outlines_given, plain_outline, tuples_of
from mbsd.model.outlines.features import CONCAVE, LINE, circle_around, features_of, is_convex, runs_of, table_of
from mbsd.model.outlines.geometry import Corner
from mbsd.model.outlines.outline import Outline, circle

WHOLE = 1.0
"""Part of the lesser size that outlines may be in each other."""
OWN = ("stiffness", "exponent", "damping", "friction", "slip_speed")


def _interactions(force, masses):
    law = [float(force.params[name]) for name in OWN]
    first, second = tuples_of(force.params["outline_i"]), tuples_of(force.params["outline_j"])
    around, other = circle_around(first), circle_around(second)
    out = [Interaction("outline", force.i, force.j, [*_table(first, second, True), *law, *around, *other])]
    if any(feature.kind in (LINE, CONCAVE) for feature in features_of(second)):
        numbers = [*_table(second, first, False), *law, *other, *around]
        out.append(Interaction("outline", force.j, force.i, numbers))
    return tuple(out)


def _table(i: tuple[Corner, ...], j: tuple[Corner, ...], arcs: bool) -> tuple[float, ...]:
    return table_of(i, j, tuple(range(len(runs_of(j)))), not is_convex(i), arcs, WHOLE)


OUTLINE_FORCE = register_force(
    ForceKind(
        "outline_force",
        interactions=_interactions,
        example=lambda m, i, j: m.outline_force(
            "example", i, j, circle(30.0, (-30.0, 0.0)), circle(4.0, (0.1, 0.2)), 50.0, damping=0.02, friction=0.4,
            slip_speed=5.0,
        ),
    )
)  # fmt: skip


@OUTLINE_FORCE.adds
def outline_force(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    outline_i: Sequence[Sequence[float]],
    outline_j: Sequence[Sequence[float]],
    stiffness: float,
    exponent: float = 1.5,
    damping: float = 0.0,
    friction: float = 0.0,
    slip_speed: float = 1e-3,
) -> Force:
    """Add the force of :func:`yielding_outline_contact` between outlines in the axes of two markers.

    Outlines are corners (x, y, bulge) (m).
    """
    what = f"{m.name}: force '{name}'"
    params: dict[str, Any] = amounts_given(m, name, stiffness=stiffness, damping=damping, friction=friction)
    params |= exponent_given(m, name, exponent) | above_zero(m, name, slip_speed=slip_speed)
    params["outline_i"] = plain_outline(f"{what}: outline_i", outline_i)
    params["outline_j"] = plain_outline(f"{what}: outline_j", outline_j)
    return add_force(m, OUTLINE_FORCE, name, i, j, params)


def yielding_outline_contact(
    m: Model,
    name: str,
    a: Outline | Body | str,
    b: Outline | Body | str,
    stiffness: float,
    exponent: float = 1.5,
    damping: float = 0.0,
    friction: float = 0.0,
    slip_speed: float = 1e-3,
) -> tuple[Force, ...]:
    """Let outlines of two bodies push each other by penalty, and return a force for each pair.

    ``a`` and ``b`` are those of :func:`outline_contact`, the numbers those of :func:`contact`: each place that is in
    the other outline is pushed out with stiffness * depth^exponent * (1 + damping * rate of depth).
    """
    what = f"force '{name}'"
    pairs = [(first, other) for first in outlines_given(m, what, a) for other in outlines_given(m, what, b)]
    check_two_bodies(m, what, pairs)
    names = [name] if len(pairs) == 1 else [f"{name} {k}" for k in range(1, len(pairs) + 1)]
    for each in names:
        new_name(m, each, "force", *connections(m))
    return tuple(
        outline_force(
            m, each, first.body.at(0.0, 0.0), other.body.at(0.0, 0.0), first.corners, other.corners,
            stiffness, exponent, damping, friction, slip_speed,
        )
        for each, (first, other) in zip(names, pairs, strict=True)
    )  # fmt: skip
