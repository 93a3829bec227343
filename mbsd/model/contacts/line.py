"""Contact of a point or disc with a straight line: ground, a wall, an incline, a body's face.

    g = y - r            constraint `linear`; y: of marker j across the x axis of marker i, free side positive
    s = x + r a          constraint `linear`; way along the line of the touching point of the disc

N pushes marker j to the positive side. The line has no ends.
"""

from __future__ import annotations

from mbsd.model.adding.contacts import add_contact, amounts_given, frictions_given
from mbsd.model.body import Marker
from mbsd.model.contact import ContactKind, register
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model


def _numbers(params):
    radius = params["radius"]
    return (0.0, 1.0, 0.0, radius), (1.0, 0.0, radius, 0.0)


LINE = register(
    ContactKind(
        "rigid_contact",
        ("linear", "linear"),
        example=lambda m, i, j: m.rigid_contact("example", i, j),
        numbers=_numbers,
        lengths=("radius",),
        touching="line",
    )
)


@LINE.adds
def rigid_contact(
    m: Model,
    name: str,
    line: Marker,
    point: Marker,
    radius: float = 0.0,
    restitution: float = 0.0,
    friction: float = 0.0,
    static_friction: float | None = None,
) -> Joint:
    """Keep a point, or a disc of ``radius`` (m) around it, on the positive side of ``line``'s x axis.

    ``friction`` is Coulomb's coefficient; ``static_friction``, the same if not given, holds what sticks.
    """
    params = amounts_given(m, name, radius=radius) | frictions_given(m, name, friction, static_friction)
    return add_contact(m, LINE, name, line, point, restitution, params)
