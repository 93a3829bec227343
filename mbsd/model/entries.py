"""Entries of a model: joints, drivers, forces and contacts with their arguments checked.

Functions ``..._given`` check arguments and return them as params. The others enter a joint, force or contact. Forces
are in N, torques in N m, counter-clockwise positive.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.arguments import finite_number, number_pair
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.body import Body, Marker
from mbsd.model.force import Force, ForceKind
from mbsd.model.joint import ContactKind, Joint, JointKind
from mbsd.model.laws import Motion
from mbsd.model.laws.curve import Curve
from mbsd.model.laws.function import Function
from mbsd.model.mechanism import (
    Model,
    connections,
    length_given,
    new_name,
    not_negative,
    number_given,
    own_body,
    two_bodies,
)
from mbsd.model.teeth import FEWEST

if TYPE_CHECKING:
    pass


Limits = Sequence[float | None] | None
Law = Motion | Callable[[float], float]


def limits_given(m: Model, name: str, limits: Limits) -> dict[str, Any]:
    """Params of a joint's limits: none, or (lower, upper) with None on a free side. Raises ModelError."""
    if limits is None:
        return {}
    what = f"{m.name}: joint '{name}': limits"
    ends = limits.tolist() if isinstance(limits, np.ndarray) else limits
    ends = ends if isinstance(ends, list | tuple) else ()
    if len(ends) != 2 or ends[0] is ends[1] is None:
        raise ModelError(f"{what} are {shown(limits)}; give (lower, upper), None on a free side")
    lower, upper = (None if end is None else finite_number(what, end) for end in ends)
    if lower is not None and upper is not None and not lower < upper:
        raise ModelError(f"{what} are {lower:g} .. {upper:g}; the lower must be below the upper")
    return {"limits": (lower, upper)}


def join(m: Model, kind: JointKind, name: str, i: Marker, j: Marker, law: Law | None = None, **params: Any) -> Joint:
    """Enter a joint, or a driver with its law, between two markers of different bodies. Raises ModelError."""
    what = "driver" if kind.driven else "joint"
    new_name(m, name, what, *connections(m))
    two_bodies(m, f"{what} '{name}'", i, j)
    motion = None
    if kind.driven:
        if not (isinstance(law, Motion) or callable(law)):
            raise ModelError(
                f"{m.name}: driver '{name}' needs a motion law, got {shown(law)}; "
                "say constant_rate(...), harmonic(...), or a function of time"
            )
        motion = law if isinstance(law, Motion) else Function(law)
    joint = Joint(kind, name, i, j, params, motion)
    (m.drivers if kind.driven else m.joints)[name] = joint
    return joint


def wheels_given(
    m: Model, name: str, radii: Mapping[str, float | None], teeth: Sequence[int] | int | None, **size: float | None
) -> dict[str, Any]:
    """Return the arguments that give the wheels: radii, or teeth with the one ``size`` (module or pitch)."""
    what, [(unit, value)] = f"{m.name}: joint '{name}'", size.items()
    given = {key: radius for key, radius in radii.items() if radius is not None}
    by_radii, by_teeth = " and ".join(f"{key}=" for key in radii), f"teeth= and {unit}="
    if given and (teeth is not None or value is not None):
        raise ModelError(f"{what} has {', '.join(given)} and {by_teeth}; give {by_radii} (m), or {by_teeth} (m)")
    if len(given) == len(radii):
        return radii_given(m, name, **given)
    if teeth is None or value is None:
        raise ModelError(f"{what} needs {by_radii} (m), or {by_teeth} (m)")
    single = len(radii) == 1
    counts = teeth if isinstance(teeth, Sequence | np.ndarray) and not single else [teeth]
    wanted = "a whole number" if single else "two whole numbers (z_i, z_j)"
    if isinstance(counts, str) or len(counts) != len(radii):
        raise ModelError(f"{what} has teeth {shown(teeth)}; give {wanted} from {FEWEST} on")
    whole: list[int] = []
    for count in counts:
        if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < FEWEST:
            raise ModelError(f"{what} has {shown(count)} teeth; give {wanted} from {FEWEST} on")
        whole.append(int(count))
    return {"teeth": whole[0] if single else tuple(whole), **radii_given(m, name, **{unit: value})}


def radii_given(m: Model, name: str, **radii: float) -> dict[str, float]:
    """Lengths above zero (m), by name. Raises ModelError."""
    out = {key: number_given(m, f"joint '{name}': {key}", value) for key, value in radii.items()}
    for key, value in out.items():
        length_given(m, f"joint '{name}' has {key}", value)
    return out


def phase_given(m: Model, name: str, phase: Sequence[float] | None) -> tuple[float, float] | None:
    """Angles of both bodies (rad) that belong together, or None. Raises ModelError."""
    return None if phase is None else number_pair(f"{m.name}: joint '{name}': phase (rad)", phase)


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


def above_zero(m: Model, name: str, **values: float | None) -> dict[str, Any]:
    """Return numbers of a force that must be positive; None stays None. Raises ModelError."""
    for what, value in values.items():
        if value is not None and value <= 0:
            raise ModelError(f"{m.name}: force '{name}': {what} is {value:g}; it must be positive")
    return values


def exponent_given(m: Model, name: str, exponent: float) -> dict[str, Any]:
    """Return the exponent of a gas or of a contact, which is at least 1. Raises ModelError."""
    if exponent < 1.0:
        raise ModelError(f"{m.name}: force '{name}': exponent is {exponent:g}; it must be 1 or more")
    return {"exponent": exponent}


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


def stop_given(m: Model, name: str, at: float, upper: bool) -> dict[str, Any]:
    """Params of a stop. Raises ModelError."""
    return {"at": number_given(m, f"stop '{name}': at", at), "upper": bool(upper)}


def frictions_given(m: Model, name: str, friction: float, static_friction: float | None) -> dict[str, Any]:
    """Params of Coulomb friction: sliding, and sticking where given. Raises ModelError."""
    static = friction if static_friction is None else static_friction
    out = not_negative(m, f"contact '{name}'", friction=friction, static_friction=static)
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
