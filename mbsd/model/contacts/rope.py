"""Rope between two points: it pulls while it is taut and carries nothing while it is slack.

g = length - l       constraint `radial`
"""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.model.adding.contacts import add_contact, amounts_given
from mbsd.model.body import Marker
from mbsd.model.contact import ContactKind, register
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model

ROPE = register(
    ContactKind(
        "rope",
        ("radial",),
        look="cord",
        example=lambda m, i, j: m.rope("example", i, j, 5.0),
        numbers=lambda params: ((-1.0, params["length"]),),
        lengths=("length",),
    )
)


@ROPE.adds
def rope(m: Model, name: str, i: Marker, j: Marker, length: float, restitution: float = 0.0) -> Joint:
    """The points of two markers stay no more than ``length`` (m) apart."""
    params = amounts_given(m, name, length=length)
    if params["length"] <= 0:
        raise ModelError(f"{m.name}: rope '{name}' has length {length:g} m; it must be positive")
    return add_contact(m, ROPE, name, i, j, restitution, params)
