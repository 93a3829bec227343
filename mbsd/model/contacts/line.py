"""Contact of a point, or a disc around it, with a straight line: ground, a wall, an incline, the face of a body.

    g = y - r            constraint `linear`; y: of marker j across the x axis of marker i, free side positive
    s = x + r a          constraint `linear`; way along the line of the touching point of the disc

N pushes marker j to the positive side. The line has no ends.
"""

from __future__ import annotations

from mbsd.model.contacts.kind import ContactKind, register


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
    )
)
