"""Drag on the centre of mass of a body, against its velocity in the world.

F = -damping v        three rows, along the axes of the world
"""

from __future__ import annotations

from mbsd.spatial.model.body import Fixing
from mbsd.spatial.model.entries import add_force, not_negative
from mbsd.spatial.model.force import Force, ForceKind, Push, register_force
from mbsd.spatial.model.mechanism import Model, own_body
from mbsd.spatial.model.rows import AXES, along

DRAG = register_force(
    ForceKind(
        "drag",
        lambda f: [Push(along(f.i, axis, f.j), damping=f.params["damping"]) for axis in AXES],
        example=lambda m, i, j: m.drag("example", j, damping=0.7),
    )
)


@DRAG.adds
def drag(m: Model, name: str, body: Fixing, damping: float) -> Force:
    """A force (N s/m) against the velocity of a body's centre of mass."""
    what = f"{m.name}: force '{name}'"
    own = own_body(m, body, what)
    not_negative(what, damping=damping)
    return add_force(m, DRAG, name, m.ground.origin, own.marker(own.com), {"damping": damping})
