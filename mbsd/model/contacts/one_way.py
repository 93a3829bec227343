"""One-way clutch (freewheel, ratchet without play): body j turns against body i in one direction alone.

    g = side (a - a_locked)      constraint `turn`;   g' >= 0

Locked, it holds the angle at which it locked; it lets go as soon as its torque would have to pull.
"""

from __future__ import annotations

from mbsd.model.contacts.kind import ContactKind, register

ONE_WAY = register(
    ContactKind(
        "one_way",
        ("turn",),
        example=lambda m, i, j: m.one_way("example", i.body, j.body),
        numbers=lambda params: ((0.0, 0.0, -1.0 if params["clockwise"] else 1.0, 0.0),),
        always_closed=True,
    )
)
