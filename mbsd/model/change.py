"""Changes of numbers and laws of a mechanism in place, so that it is solved again without a rebuild.

A joint, driver, force or contact is added again by the method of its kind, from its own markers, the numbers and laws
that the user gave, and the new ones. So the method checks them again, and derives the others from them. The order of
entries stays, and compiled code is used as it is. A body is rebuilt likewise, and the present one takes its numbers,
because markers refer to it.

The types of the arguments of the function that adds an entry say what they are:

Marker                   one of the two markers
Body | str               a body of one of them, or its name; with None one that may be left out
str | Body               another body, which the params keep by its name
Law                      a law of time: a Motion, or a function
Amount                   a number, or a law of time
Curve, Curve | None      a characteristic curve
all others               numbers, switches, texts and lists, which Joint.params and Force.params keep by name
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import replace
from enum import Enum
from functools import lru_cache
from typing import Any, NamedTuple

from mbsd.base.arguments import types_of
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.model.body import Body, Marker, at_end
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.laws import Motion
from mbsd.model.laws.curve import Curve
from mbsd.model.mechanism import Model, connections, new_bar, new_body

BODY = ("mass", "com", "inertia", "z", "products")
BAR = ("length", *BODY)


def with_markers(
    add: Callable[..., Any], markers: list[Marker], named: Mapping[str, Any], bodies: Mapping[str, Body]
) -> tuple[list[Any], dict[str, Any]]:
    """Arguments of the function that adds a joint, driver, force or contact: in order and by name.

    They are those ``named``, its markers and bodies. Parameters that must be markers or bodies take the last of
    ``markers`` (i and j) in order, a body that may be given (``against``, ``frame``) takes what is left. Where any
    number of ``bodies`` may be given, their names are among those ``named``.
    """
    out = dict(named)
    known = arguments(add)
    slots = [parameter for parameter in known if parameter.name not in named]
    needed = [slot for slot in slots if slot.role in (Role.MARKER, Role.BODY) and not slot.several]
    given = [slot for slot in slots if slot.role is Role.OPTIONAL_BODY]
    left = markers[: len(markers) - len(needed)]
    for slot, marker in [*zip(needed, markers[len(left) :], strict=False), *zip(given, left, strict=False)]:
        out[slot.name] = marker if slot.role is Role.MARKER else marker.body
    for k, parameter in enumerate(known):
        if parameter.several:
            several = [bodies[name] for name in out.pop(parameter.name)]
            return [*(out.pop(before.name) for before in known[:k]), *several], out
    return [], out


def law_name(add: Callable[..., Any]) -> str:
    """The argument of a driver's function that is its law."""
    [law] = [parameter.name for parameter in arguments(add) if parameter.role is Role.LAW]
    return law


def change(m: Model, name: str, values: Mapping[str, Any]) -> None:
    """See :meth:`mbsd.mechanism.Mechanism.change`."""
    for table in connections(m):
        if isinstance(name, str) and name in table and not _of_body_alone(m, table[name], name, values):
            return _change(m, table, name, values)  # pyright: ignore[reportArgumentType]
    if not isinstance(name, str) or name not in m.bodies or name == "ground":
        known = [*(key for table in connections(m) for key in table), *(body for body in m.bodies if body != "ground")]
        raise ModelError(f"{m.name}: {no_such('body, joint, driver, force or contact', name, known)}")
    return _change_body(m, m.bodies[name], values)


def given(entry: Joint | Force) -> dict[str, Any]:
    """Return the arguments of the method that added it, but for markers and bodies.

    They are those that the user gave, laws included.
    """
    named = entry.given
    if isinstance(entry, Force):
        return {**named, **entry.laws}
    if entry.motion is not None and entry.kind.add is not None:
        named[law_name(entry.kind.add)] = entry.motion
    return named


def _change(m: Model, table: dict[str, Any], name: str, values: Mapping[str, Any]) -> None:
    old: Joint | Force = table[name]
    add = old.kind.add
    assert add is not None
    also = old.kind.also if isinstance(old, Force) else {}
    values = {also.get(key, key): value for key, value in values.items()}
    _check_names(m, f"{old.kind.name} '{name}'", values, _own(old))
    if not values:
        return
    before = dict(table)
    del table[name]
    try:
        in_order, named = with_markers(add, [old.i, old.j], given(old) | values, m.bodies)
        add(m, name, *in_order, **named)
    except BaseException:
        table.clear()
        table.update(before)
        raise
    new = table[name]
    table.clear()
    table.update({key: new if key == name else value for key, value in before.items()})


def _of_body_alone(m: Model, entry: Any, name: str, values: Mapping[str, Any]) -> bool:
    """Return True if a body has the name of an entry, and takes values that the entry does not know."""
    body = m.bodies.get(name)
    return (
        body is not None
        and bool(values)
        and set(values) <= set(BODY if body.length is None else BAR)
        and not set(values) & set(_own(entry))
    )


def _own(entry: Joint | Force) -> list[str]:
    """Arguments of the method that added it which are neither markers nor bodies."""
    assert entry.kind.add is not None
    others = (Role.MARKER, Role.BODY, Role.OPTIONAL_BODY)
    return [parameter.name for parameter in arguments(entry.kind.add) if parameter.role not in others]


def takes(m: Model, name: str, key: str) -> bool:
    """Return True if :func:`change` takes an argument ``key`` of what has this name."""
    for table in connections(m):
        if name in table:
            entry: Any = table[name]
            if key in _own(entry) or (isinstance(entry, Force) and key in entry.kind.also):
                return True
    body = m.bodies.get(name)
    return body is not None and name != "ground" and key in (BODY if body.length is None else BAR)


def values_of(m: Model, name: str) -> dict[str, Any] | None:
    """Return what :func:`change` takes for a name, with values, also derived; None if unknown."""
    for table in connections(m):
        if name in table:
            entry: Any = table[name]
            return {**entry.params, **given(entry)}
    if not isinstance(name, str) or name not in m.bodies or name == "ground":
        return None  # pyright: ignore[reportReturnType]
    body = m.bodies[name]
    return {key: getattr(body, key) for key in (BODY if body.length is None else BAR)} | given_body(body)


def given_body(body: Body) -> dict[str, Any]:
    """Arguments of the method that added it: what the user gave."""
    mass = body.mass if body.mass_given or body.mass > 0 else None
    out = {"mass": mass} | {key: getattr(body, key) for key in ("com", "inertia") if key not in body.derived}
    out |= {"z": body.z, "products": body.products, "looks": body.looks}
    return out if body.length is None else {"length": body.length} | out


def _change_body(m: Model, body: Body, values: Mapping[str, Any]) -> None:
    bar = body.length is not None
    _check_names(m, f"body '{body.name}'", values, BAR if bar else BODY)
    new = (new_bar if bar else new_body)(m, body.name, **(given_body(body) | dict(values)))
    if body.length is not None and new.length is not None and new.length != body.length:
        _move_ends(m, body, body.length, new.length)
    body.copy_properties(new)


def _move_ends(m: Model, bar: Body, old: float, new: float) -> None:
    """Let everything at the end of a bar of the ``old`` length follow it to the ``new`` one (m)."""

    def moved(marker: Marker) -> Marker:
        return replace(marker, x=new) if marker.body is bar and at_end(marker, old) else marker

    for table in connections(m):
        for name, entry in table.items():
            assert isinstance(entry, Joint | Force)
            follows = {key: marker for key, value in entry.params.items()
                       if isinstance(value, Marker) and (marker := moved(value)) is not value}  # fmt: skip
            i, j = moved(entry.i), moved(entry.j)
            if i is not entry.i or j is not entry.j or follows:
                table[name] = replace(entry, i=i, j=j, params={**entry.params, **follows})  # pyright: ignore[reportIndexIssue]
    for name, marker in m.traces.items():
        m.traces[name] = moved(marker)
    for name, event in m.events.items():
        m.events[name] = event.moved(moved)


def _check_names(m: Model, what: str, values: Mapping[str, Any], known: tuple[str, ...] | list[str]) -> None:
    others = [key for key in values if key not in known]
    if others:
        raise ModelError(f"{m.name}: {what}: {no_such('argument', others[0], known)}")


class Role(Enum):
    """The role of an argument."""

    MARKER, BODY, OPTIONAL_BODY, LAW, AMOUNT, CURVE, VALUE = range(7)


class Argument(NamedTuple):
    """One argument of a function that adds something to a model."""

    name: str
    role: Role
    types: tuple[Any, ...]
    """Types that it may have; one that is not known where the function stands is text."""
    needed: bool
    """True if it has no default."""
    several: bool
    """True if it stands for any number of arguments, as ``*bodies`` does."""


@lru_cache(maxsize=512)
def arguments(add: Callable[..., Any]) -> tuple[Argument, ...]:
    """Return arguments of ``add(m, name, ...)`` after the mechanism and the name, or of a law's function."""
    known = types_of(add)
    return tuple(
        Argument(p.name, _role(known[p.name]), known[p.name], p.default is p.empty, p.kind is p.VAR_POSITIONAL)
        for p in inspect.signature(add).parameters.values()
        if p.name not in ("m", "name") and Model not in known[p.name]
    )


def _role(types: tuple[Any, ...]) -> Role:
    if Marker in types:
        return Role.MARKER
    if Body in types and types[0] is not str:
        return Role.OPTIONAL_BODY if type(None) in types else Role.BODY
    if Curve in types:
        return Role.CURVE
    if Motion in types:
        return Role.AMOUNT if float in types else Role.LAW
    return Role.VALUE
