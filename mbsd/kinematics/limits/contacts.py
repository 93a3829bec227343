"""Rigid contacts, stops and limits in analyses without contact forces: sweeps, statics and others.

Only a simulation knows the forces of contacts. Elsewhere a motion or pose that needs them ends in an error that names
the contact. Gaps are residuals of rows of J that a second packing has for contacts and for limits of joints.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.packing import Packed, pack
from mbsd.base.errors import EquilibriumError, LimitError, ModelError
from mbsd.kinematics.limits.joints import coordinate, limits_of
from mbsd.kinematics.pose.phases import refuse_impossible, take_decided, take_phases
from mbsd.model.contacts import ANGLE_STOP, COORDINATE_STOP
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model

if TYPE_CHECKING:
    from mbsd.results.solution import Solution


INSIDE = 1e-9
"""In sizes and rad: bodies that are so far inside each other still only touch."""


@dataclass(frozen=True)
class Gap:
    """A contact's gap along a motion: (T,) in ``unit``, and what counts as touching."""

    name: str
    value: np.ndarray
    slack: float
    unit: str


def gaps(m: Model, packed: Packed, q: np.ndarray, limits: bool) -> list[Gap]:
    """Return gaps of contacts and ``limits`` along poses q (T, 3 nb).

    One-way clutches are closed.
    """
    from mbsd.equations.assembly import tabulate
    from mbsd.kinematics.limits.contacts import all_contacts, with_contacts

    contacts = all_contacts(m, packed, q[0]) if limits else list(m.contacts.values())
    if not contacts:
        return []
    wide = with_contacts(m, packed, contacts, q[0])
    count, rows = len(q), len(wide.ws.phi)
    phi, gamma, compact = np.zeros((count, rows)), np.zeros((count, rows)), np.zeros((count, rows, 6))
    drives = np.zeros((count, len(wide.motions) + 1, 3))
    tabulate(wide.system, drives, q, np.zeros_like(q), wide.ws, phi, compact, gamma)
    first, angular, scale = len(wide.joints) - wide.contacts, set(wide.specials.angular_rows), wide.row_scale()
    listed = []
    for contact, row in zip(contacts, wide.first_row[first:-1], strict=True):
        value = np.zeros(count) if getattr(contact.kind, "always_closed", False) else phi[:, row]
        listed.append(Gap(contact.name, value, float(INSIDE / scale[row]), "rad" if row in angular else "m"))
    return listed


def refuse_passed_contacts(m: Model, packed: Packed, times: np.ndarray, q: np.ndarray) -> None:
    """Raise LimitError where a driven motion q (T, 3 nb) goes through a contact."""
    for gap in gaps(m, packed, q, limits=False):
        if gap.value.min() < -gap.slack:
            at = int(np.flatnonzero(gap.value < -gap.slack)[0])
            before = max(at - 1, 0)
            share = max(gap.value[before], 0.0) / (gap.value[before] - gap.value[at]) if at else 1.0
            time = times[before] + share * (times[at] - times[before])
            raise LimitError(
                f"{m.name}: at t = {time:.6g} s the motion is beyond contact '{gap.name}', at the furthest by "
                f"{-gap.value.min():.3g} {gap.unit}. Drive less far, or simulate, where contacts push back."
            )


def refuse_resting(m: Model, packed: Packed, start: np.ndarray, q: np.ndarray, said: str | None = None) -> None:
    """Raise EquilibriumError for a pose q (3 nb,), found from ``start``, beyond a contact or limit.

    ``said``: how the text begins where the pose does not balance.
    """
    for gap in gaps(m, packed, np.stack([start, q]), limits=True):
        if gap.value[1] < -gap.slack:
            begun = said or f"{m.name}: the pose that balances is"
            raise EquilibriumError(
                f"{begun} {-gap.value[1]:.3g} {gap.unit} beyond '{gap.name}'. Rest on a "
                "contact or at a limit is not searched for. Simulate with damping until it rests, or start nearer to a "
                "pose without contact."
            )


def refuse_closed(m: Model, packed: Packed, q: np.ndarray) -> None:
    """Raise ModelError for a state q (3 nb,) in which a contact is closed: it has no linear neighbourhood."""
    for gap in gaps(m, packed, q[None], limits=True):
        if gap.value[0] <= gap.slack:
            raise ModelError(
                f"{m.name}: '{gap.name}' is closed in this state, and a contact pushes to one side only, so there is "
                "no linear motion about it. Linearise where it is open, or put a joint or spring in its place."
            )


def refuse_pushing(m: Model, motion: Solution) -> None:
    """Raise ModelError if a contact pushes during a motion.

    Its forces would be put on the actuators.
    """
    for name in motion.packed.contact_gaps():
        closed = motion.contact(name).closed
        if closed.any():
            raise ModelError(
                f"{m.name}: contact '{name}' pushes at t = {motion.t[int(np.argmax(closed))]:.6g} s of this "
                "motion. Efforts are found for motions without contact alone; cut the motion there."
            )


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


def with_contacts(m: Model, packed: Packed, contacts: list[Joint], start: np.ndarray) -> Packed:
    """Return the mechanism with rows for contacts after all others, and the phases of its start (3 nb,)."""
    out = pack(m, contacts)
    out.motions = packed.motions
    take_decided(out, packed)
    out.specials.callbacks += packed.specials.callbacks  # some of these numbers are their addresses
    refuse_impossible(out, start)
    spans = [k for k in out.specials.phased if k >= len(packed.specials.names) and out.specials.names[k] == "span"]
    take_phases(out, start, np.zeros((len(out.motions) + 1, 3)), spans)
    return out
