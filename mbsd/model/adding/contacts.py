"""Adding a unilateral contact: its checks, and its entry."""

from __future__ import annotations

from typing import Any

from mbsd.base.errors import ModelError
from mbsd.model.body import Marker
from mbsd.model.contact import ContactKind
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model, connections, new_name, not_negative, number_given, two_bodies


def stop_given(m: Model, name: str, at: float, upper: bool) -> dict[str, Any]:
    """Params of a stop. Raises ModelError."""
    at = number_given(m, f"stop '{name}': at", at)
    return {"at": at, "upper": bool(upper)}


def amounts_given(m: Model, name: str, **values: float) -> dict[str, Any]:
    """Numbers that may not be negative. Raises ModelError."""
    return not_negative(m, f"contact '{name}'", **values)


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
    two_bodies(m, f"contact '{name}'", i, j)
    if restitution is not None:
        params["restitution"] = number_given(m, f"contact '{name}': restitution", restitution)
        if not 0.0 <= params["restitution"] <= 1.0:
            raise ModelError(f"{m.name}: contact '{name}': restitution is {restitution:g}; it must be 0 .. 1")
    contact = m.contacts[name] = Joint(kind, name, i, j, params)
    return contact
