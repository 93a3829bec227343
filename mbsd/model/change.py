"""Numbers and laws of a mechanism changed where it stands, so that it is solved again without being built again.

A joint, driver, force or contact is made anew by the method of its kind's name, from its own markers, numbers and laws
and the new ones, so what the method refuses stays refused. Its place among the others stays too, and compiled code is
used as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.model.body import Marker
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.mechanism import connections
from mbsd.model.roles import Role, arguments

if TYPE_CHECKING:
    from mbsd.model.mechanism import Model

BODY = ("mass", "com", "inertia")


def with_markers(add: Callable[..., Any], markers: list[Marker], named: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of the function that adds a joint, driver, force or contact: those ``named``, its markers and bodies.

    Parameters that must be markers or bodies take the last of ``markers`` (i and j) in order, a body that may be given
    (``against``, ``frame``) takes what is left.
    """
    out = dict(named)
    slots = [one for one in arguments(add) if one.name not in named]
    needed = [one for one in slots if one.role in (Role.MARKER, Role.BODY)]
    given = [one for one in slots if one.role is Role.OPTIONAL_BODY]
    left = markers[: len(markers) - len(needed)]
    for slot, marker in [*zip(needed, markers[len(left) :], strict=False), *zip(given, left, strict=False)]:
        out[slot.name] = marker if slot.role is Role.MARKER else marker.body
    return out


def law_name(add: Callable[..., Any]) -> str:
    """The argument of a driver's function that is its law."""
    [law] = [one.name for one in arguments(add) if one.role is Role.LAW]
    return law


def change(m: Model, name: str, values: Mapping[str, Any]) -> None:
    """See :meth:`mbsd.mechanism.Mechanism.change`."""
    for table in connections(m):
        if isinstance(name, str) and name in table:
            return _change(m, table, name, values)  # pyright: ignore[reportArgumentType]
    if not isinstance(name, str) or name not in m.bodies or name == "ground":
        known = [*(key for table in connections(m) for key in table), *(body for body in m.bodies if body != "ground")]
        raise ModelError(f"{m.name}: {no_such('body, joint, driver, force or contact', name, known)}")
    body = m.bodies[name]
    _refuse_others(m, f"body '{name}'", values, BODY)
    m.set_mass(name, **({key: getattr(body, key) for key in BODY} | dict(values)))
    return None


def _change(m: Model, table: dict[str, Any], name: str, values: Mapping[str, Any]) -> None:
    old: Joint | Force = table[name]
    add = old.kind.add
    assert add is not None
    own = [one.name for one in arguments(add) if one.role not in (Role.MARKER, Role.BODY, Role.OPTIONAL_BODY)]
    if any(one.several for one in arguments(add)):
        own = []
    what = f"{old.kind.name} '{name}'"
    _refuse_others(m, what, values, own)
    if not values:
        return
    named = dict(old.params)
    if isinstance(old, Force):
        named |= old.laws
    elif old.motion is not None:
        named[law_name(add)] = old.motion
    before = dict(table)
    del table[name]
    try:
        add(m, name, **with_markers(add, [old.i, old.j], named | dict(values)))
    except BaseException:
        table.clear()
        table.update(before)
        raise
    new = table[name]
    table.clear()
    table.update({key: new if key == name else value for key, value in before.items()})


def _refuse_others(m: Model, what: str, values: Mapping[str, Any], known: tuple[str, ...] | list[str]) -> None:
    others = [key for key in values if key not in known]
    if others:
        raise ModelError(f"{m.name}: {what}: {no_such('argument', others[0], known)}")
