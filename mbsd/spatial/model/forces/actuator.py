"""Actuator: a force between two places, a number or a law of time.

F = amount(t)        it pushes the places apart
"""

from __future__ import annotations

from mbsd.spatial.model.body import Fixing, Place
from mbsd.spatial.model.entries import Law, add_force, amount_given, ends_given
from mbsd.spatial.model.force import Force, ForceKind, Push, register_force
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import distance

ACTUATOR = register_force(
    ForceKind(
        "actuator",
        lambda f: [Push(distance(f.i, f.j), amount=f.params.get("amount", 0.0), law="amount" if f.laws else "")],
        example=lambda m, i, j: m.actuator("example", i, j, 4.0, start=(0.1, 0.2, 0.3), end=(-0.2, 0.5, 0.8)),
    )
)


@ACTUATOR.adds
def actuator(
    m: Model, name: str, first: Fixing, second: Fixing, amount: float | Law, start: Place | None = None,
    end: Place | None = None,
) -> Force:  # fmt: skip
    """A force (N) that pushes ``start`` on the first body and ``end`` on the second apart."""
    what = f"{m.name}: force '{name}'"
    i, j = ends_given(m, what, first, second, start, end)
    params, laws = amount_given(what, amount)
    return add_force(m, ACTUATOR, name, i, j, params, laws)
