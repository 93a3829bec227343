"""Arrays of a mechanism with changed numbers: only affected arrays are packed anew.

Most numbers are a mass, a number of a force, gravity or a start: markers, joints and tables stay as they are, and only
a few entries are written anew. Whatever moves a marker or a joint is packed as a whole.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from operator import is_
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.model.body import Marker
from mbsd.model.force import Force
from mbsd.model.mechanism import Model
from mbsd.numbers.saved import SavedModel

PLACES = ("marker_arm", "marker_axis", "angle_offset", "distance_length", "numbers")
"""Arrays of a system that follow from where markers are, and from lengths and angles."""
MASSES = ("mass", "inertia")
NUMBERS_OF_LOADS = ("place", "number", "given", "user_com", "friction_number")
TABLES_OF_LOADS = ("element", "term", "interaction", "user", "user_body", "friction")
"""Tables that describe forces without their numbers."""


def repacked(m: Model, packed: Packed, saved: SavedModel) -> Packed | None:
    """Return ``packed`` of the ``saved`` model, with the changes in ``m``; None if a place has changed."""
    joints = m.joints, m.drivers, m.contacts
    if m is not saved.m or not all(unchanged(table, saved) for table in joints):
        return None
    if packed.specials.phased or any("function" in joint.params for joint in packed.specials.joints):
        return None  # their constants follow from the start pose, their addresses from the packed mechanism
    bodies = saved.bodies
    if any(body.com != before["com"] for body, before in bodies):
        return None
    forces = _forces(m, saved)
    if forces is None:
        return None
    system, changes = packed.system, dict[str, np.ndarray]()
    for name in ("mass", "inertia"):
        if any(getattr(body, name) != before[name] for body, before in bodies):
            changes[name] = np.array([getattr(body, name) for body, _ in bodies])
    if m.gravity != saved.gravity:
        changes["gravity"] = np.array(m.gravity or (0.0, 0.0), float)
    if changes:
        packed = replace(packed, system=system.changed(**changes), constant=None)
    return replace(packed, forces=forces, motions=list(packed.motions), phases=dict(packed.phases))


def _forces(m: Model, saved: SavedModel) -> list[Force] | None:
    """The forces; None where one of them acts elsewhere than before."""
    before = saved.before(m.forces)
    if len(m.forces) != len(before):
        return None
    for force, old in zip(m.forces.values(), before.values(), strict=True):
        if force is not old and not (same_place(force.i, old.i) and same_place(force.j, old.j)):
            return None
        if force.kind is not old.kind:
            return None
    return list(m.forces.values())


def same_place(marker: Marker, other: Marker) -> bool:
    """Return True for one place of a body, whether or not it is the same marker."""
    if marker is other:
        return True
    places = (marker.x, marker.y, marker.angle), (other.x, other.y, other.angle)
    return marker.body is other.body and places[0] == places[1]


def unchanged(table: Mapping[str, Any], saved: SavedModel) -> bool:
    """Return True if a table of the model holds what it held."""
    before = saved.before(table)
    return len(table) == len(before) and all(map(is_, table.values(), before.values()))


def same_laws(laws: Sequence[Any], others: Sequence[Any]) -> bool:
    """Return True for the very same laws."""
    return len(laws) == len(others) and all(map(is_, laws, others))


def laws_of(packed: Packed) -> list[Any]:
    """Return the laws of all forces."""
    return [law for force in packed.forces for law in force.laws.values()]


def alike(arrays: Any, others: Any, names: Sequence[str]) -> bool:
    """Return True if arrays of these names are equal in two systems or loads, or both are missing."""
    if arrays is None or others is None:
        return arrays is others
    pairs = [(getattr(arrays, name), getattr(others, name)) for name in names]
    return all(a is b or a.tobytes() == b.tobytes() for a, b in pairs)
