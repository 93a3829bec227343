"""Rows of J for contacts and for limits of joints."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed, pack
from mbsd.kinematics.limits.joints import coordinate, limits_of
from mbsd.kinematics.pose.phases import take_decided
from mbsd.model.contacts import ANGLE_STOP, COORDINATE_STOP
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model


def all_contacts(m: Model, packed: Packed, q: np.ndarray) -> list[Joint]:
    """Return the contacts, and stops without rebound at joint limits; q (3 nb,) at the start.

    Angles are counted from the whole turn that is nearest to the limits at the start.
    """
    out = list(m.contacts.values())
    for limit in limits_of(packed):
        joint = m.joints[limit.name]
        turns = 0.0
        if limit.angular:
            i, j = packed.system.marker_body[[limit.marker_i, limit.marker_j]]
            turns = q[3 * j + 2] - q[3 * i + 2] + limit.offset - coordinate(packed, limit, q[None])[0]
        kind = ANGLE_STOP if limit.angular else COORDINATE_STOP
        for end, at in (("lower", limit.lower), ("upper", limit.upper)):
            if np.isfinite(at):
                params = {"at": at + turns, "upper": end == "upper"}
                out.append(Joint(kind, f"{joint.name} {end}", joint.i, joint.j, params))
    return out


def with_contacts(m: Model, packed: Packed, contacts: list[Joint]) -> Packed:
    """The same mechanism with rows for contacts after all others, and the phases that its start decided."""
    out = pack(m, contacts)
    out.motions = packed.motions
    take_decided(out, packed)
    out.specials.callbacks += packed.specials.callbacks  # some of these numbers are their addresses
    return out
