"""Numbers of contacts that vary, by their places in the block of a prepared run: restitution and friction."""

from __future__ import annotations

import numpy as np

from mbsd.base.errors import MechanismError
from mbsd.dynamics.many.base import Base
from mbsd.dynamics.many.contacts.arrays import KINETIC, RESTITUTION, STATIC, Contacts
from mbsd.dynamics.many.designs import Designs

PLAIN = ("restitution", "friction", "static_friction")


def contact_columns(
    designs: Designs, base: Base, name: str, values: dict[str, np.ndarray]
) -> list[tuple[int, np.ndarray]] | None:
    """Places in the block and values (n,) of all rows for the contact ``name``; None where more depends on them."""
    if not set(values) <= {*PLAIN} or any(column.ndim > 1 for column in values.values()):
        return None
    columns = {key: np.ascontiguousarray(column) for key, column in values.items()}
    if _static_follows(designs, name, columns):
        columns["static_friction"] = columns["friction"]
    if not _accepted(designs, name, columns):
        return None
    own, contacts = base.run.ready.switches.contacts, next((a for a in base.arguments if isinstance(a, Contacts)), None)
    if contacts is None:  # arguments of a loop that meets none
        return []
    k = [contact.name for contact in own].index(name)
    out, friction = [], own[k].sliding
    for key, column in columns.items():
        if key == "restitution":
            out.append((base.layout.place(contacts.number, k, RESTITUTION), column))
        elif friction < 0:
            return None
        else:
            at = KINETIC if key == "friction" else STATIC
            out.append((base.layout.place(contacts.friction.number, friction, at), column))
    return out


def _static_follows(designs: Designs, name: str, columns: dict[str, np.ndarray]) -> bool:
    """Whether static friction, not given by the author, is the friction that varies."""
    if "friction" not in columns or "static_friction" in columns:
        return False
    lowest = float(columns["friction"].min())
    work = designs.copied()
    try:
        work.change(name, friction=lowest)
    except MechanismError:
        return False
    return work.contacts[name].params["static_friction"] == lowest


def _accepted(designs: Designs, name: str, columns: dict[str, np.ndarray]) -> bool:
    """Whether all rows have friction, and each number's least and largest is taken as it is."""
    before = designs.m.contacts[name].params
    friction = columns.get("friction", np.array(before.get("friction", 0.0)))
    static = columns.get("static_friction", np.array(before.get("static_friction", 0.0)))
    if not (static >= friction).all() or ("friction" in columns and not (friction > 0.0).all()):
        return False
    for row in {int(at) for column in columns.values() for at in (column.argmin(), column.argmax())}:
        given = {key: float(column[row]) for key, column in columns.items()}
        work = designs.copied()
        try:
            work.change(name, **given)
        except MechanismError:
            return False
        after = work.contacts[name].params
        others = {*before, *after} - {*given}
        if not all(np.array_equal(np.asarray(before.get(key)), np.asarray(after.get(key))) for key in others):
            return False
        if any(after[key] != value for key, value in given.items()):
            return False
    return True
