"""Rope between two points: it pulls when it is taut and lets go when it is slack.

g = length - l       constraint `radial`
"""

from __future__ import annotations

from mbsd.model.contacts.kind import ContactKind, register

ROPE = register(
    ContactKind(
        "rope",
        ("radial",),
        example=lambda m, i, j: m.rope("example", i, j, 5.0),
        numbers=lambda params: ((-1.0, params["length"]),),
        lengths=("length",),
    )
)
