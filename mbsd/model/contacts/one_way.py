"""One-way clutch (freewheel, ratchet without play): body j turns against body i one way only.

    g = side (a - a_locked)      constraint `turn`;   g' >= 0

Locked, it holds the angle at which it locked; it opens as soon as its torque would have to pull.
"""

from __future__ import annotations

from mbsd.model.adding.contacts import add_contact
from mbsd.model.body import Body
from mbsd.model.contact import ContactKind, register
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model, own_body

ONE_WAY = register(
    ContactKind(
        "one_way",
        ("turn",),
        example=lambda m, i, j: m.one_way("example", i.body, j.body),
        numbers=lambda params: ((0.0, 0.0, -1.0 if params["clockwise"] else 1.0, 0.0),),
        always_closed=True,
    )
)


@ONE_WAY.adds
def one_way(m: Model, name: str, first: Body | str, second: Body | str, clockwise: bool = False) -> Joint:
    """A one-way clutch: ``second`` turns against ``first`` only counter-clockwise, or only clockwise."""
    i, j = (own_body(m, body, f"contact '{name}'").origin for body in (first, second))
    return add_contact(m, ONE_WAY, name, i, j, None, {"clockwise": bool(clockwise)})
