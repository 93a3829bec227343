"""Adding a force: its checks, and its entry. Forces in N, torques in N m, counter-clockwise positive."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.body import Body, Marker
from mbsd.model.force import Force, ForceKind
from mbsd.model.laws import Motion
from mbsd.model.laws.curve import Curve
from mbsd.model.laws.function import Function
from mbsd.model.mechanism import Model, connections, new_name, not_negative, number_given, own_body, two_bodies

Amount = float | Motion | Callable[[float], float]
"""A constant, or a law of time."""


def add_force(
    m: Model,
    kind: ForceKind,
    name: str,
    i: Marker,
    j: Marker,
    params: Mapping[str, Any],
    laws: Mapping[str, Motion | Curve] | None = None,
    same_body: bool = False,
) -> Force:
    """Enter a force between two markers. Raises ModelError."""
    new_name(m, name, "force", *connections(m))
    two_bodies(m, f"force '{name}'", i, j, same_body)
    force = m.forces[name] = Force(kind, name, i, j, dict(params), dict(laws or {}))
    return force


def origins(m: Model, name: str, first: Body | str, second: Body | str) -> tuple[Marker, Marker]:
    """Return the frames of two bodies of this mechanism, given as bodies or names. Raises ModelError."""
    what = f"force '{name}'"
    return own_body(m, first, what).origin, own_body(m, second, what).origin


def amounts_given(m: Model, name: str, **values: float) -> dict[str, Any]:
    """Numbers of a force that may not be negative. Raises ModelError."""
    return not_negative(m, f"force '{name}'", **values)


def above_zero(m: Model, name: str, what: str, value: float) -> float:
    """A number above zero. Raises ModelError."""
    value = number_given(m, f"force '{name}': {what}", value)
    if value <= 0:
        raise ModelError(f"{m.name}: force '{name}': {what} is {value:g}; it must be positive")
    return value


def law_given(m: Model, name: str, law: Any, of: str) -> dict[str, Any]:
    """Params of a function of the user. Raises ModelError."""
    if not callable(law):
        raise ModelError(f"{m.name}: force '{name}' needs a function of {of}, got {shown(law)}")
    return {"law": law}


def amount_given(m: Model, name: str, what: str, value: Amount) -> tuple[dict[str, Any], dict[str, Motion]]:
    """A constant as a param, or a law of time: (params, laws). Raises ModelError."""
    if isinstance(value, Motion):
        return {}, {what: value}
    if callable(value):
        return {}, {what: Function(value)}
    return {what: number_given(m, f"force '{name}': {what}", value)}, {}


def spring_amounts(m: Model, name: str, **values: Amount) -> tuple[dict[str, Any], dict[str, Motion]]:
    """Numbers that may not be negative, but for a free angle, and laws of time."""
    params, laws = {}, {}
    for what, value in values.items():
        own, law = amount_given(m, name, what, value)
        params |= own if what == "free_angle" else amounts_given(m, name, **own)
        laws |= law
    free = list(values)[-1]
    if "stiffness" in laws and free in laws:
        raise ModelError(
            f"{m.name}: force '{name}': stiffness and {free} are both laws of time; give one of them as a "
            "number, or write m.user_force(...)"
        )
    return params, laws


def curves_given(m: Model, name: str, **curves: Curve | None) -> dict[str, Curve]:
    """Characteristic curves that were given, one at least. Raises ModelError."""
    out = {}
    for what, curve in curves.items():
        if curve is None:
            continue
        if not isinstance(curve, Curve):
            raise ModelError(f"{m.name}: force '{name}': {what} is {shown(curve)}; it must be a curve(x, y)")
        out[what] = curve
    if not out:
        raise ModelError(f"{m.name}: force '{name}' has no curve; give {' or '.join(curves)}")
    return out
