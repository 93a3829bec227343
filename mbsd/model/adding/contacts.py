"""What adding a unilateral contact checks, and the entry it makes."""

from __future__ import annotations

from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.shown import shown
from mbsd.model.body import Marker
from mbsd.model.contact import ContactKind
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model, connections, new_name, number_given, own_body


def stop_given(m: Model, name: str, at: float, upper: bool) -> dict[str, Any]:
    """Params of a stop. Raises ModelError."""
    at = number_given(m, f"stop '{name}': at", at)
    return {"at": at, "upper": bool(upper)}


def amounts_given(m: Model, name: str, **values: float) -> dict[str, Any]:
    """Numbers that may not be negative. Raises ModelError."""
    out = {}
    for what, value in values.items():
        out[what] = number_given(m, f"contact '{name}': {what}", value)
        if out[what] < 0:
            raise ModelError(f"{m.name}: contact '{name}': {what} is {value:g}; it cannot be negative")
    return out


def frictions_given(m: Model, name: str, friction: float, static_friction: float | None) -> dict[str, Any]:
    """Params of Coulomb friction: sliding, and sticking where given. Raises ModelError."""
    static = friction if static_friction is None else static_friction
    out = amounts_given(m, name, friction=friction, static_friction=static)
    if out["static_friction"] < out["friction"] or (out["friction"] == 0.0 and static > 0.0):
        raise ModelError(
            f"{m.name}: contact '{name}': static_friction is {static:g}, friction {friction:g}; static friction "
            "must not be less, and friction must be positive where there is static friction"
        )
    return out


def add_contact(
    m: Model, kind: ContactKind, name: str, i: Marker, j: Marker, restitution: float | None, params: dict[str, Any]
) -> Joint:
    """Enter a contact between markers of two bodies. Raises ModelError."""
    new_name(m, name, "contact", *connections(m))
    for marker in (i, j):
        if not isinstance(marker, Marker):
            raise ModelError(
                f"{m.name}: contact '{name}' needs two markers, got {shown(marker)}; "
                "write body.at(x, y), bar.start or bar.end"
            )
        own_body(m, marker.body, f"contact '{name}'")
    if i.body is j.body:
        raise ModelError(f"{m.name}: contact '{name}' is of '{i.body.name}' with itself; give two bodies")
    if restitution is not None:
        params["restitution"] = number_given(m, f"contact '{name}': restitution", restitution)
        if not 0.0 <= params["restitution"] <= 1.0:
            raise ModelError(f"{m.name}: contact '{name}': restitution is {restitution:g}; it must be 0 .. 1")
    contact = m.contacts[name] = Joint(kind, name, i, j, params)
    return contact
