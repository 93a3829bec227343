"""How the time of an event changes with numbers: that of the scalar g which falls through zero there.

    gap      a contact that was open is met                        g = Phi
    rate     a way comes to rest, a freewheel locks                g = J v - nu
    slip     friction that held is not enough                      g = mu_s N - |T|
    room     a pair of outlines comes to its end, as at a tip      g = way of the foot that is left
    user     the value of an event of the user

    t' = -(dg + g_p) / (dg/dt)

Where several contacts are met at one time and a number moves one before the other, what comes after depends on which
is first: there is no derivative by that number, nor by one that opens or closes a contact at the start.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mbsd.arrays.outline_pairs import room_at
from mbsd.arrays.packing import Packed
from mbsd.base.errors import ModelError
from mbsd.derivatives.driven.tangents import along_direction, per_scales
from mbsd.derivatives.numbers.terms import Along, Left, Terms
from mbsd.derivatives.numbers.variants import SECOND, Variants
from mbsd.dynamics.events.moment import Moment
from mbsd.model.event import Happening
from mbsd.model.joint import ContactKind, Joint

GAP, RATE, SLIP, ROOM, USER = "gap", "rate", "slip", "room", "user"
REACH = 1e-5
"""Reach of differences along a tangent, in sizes, rad, and parts of the fastest speed."""
INSTANT = 1e-6
"""Part of the duration by which time goes on for the rate of an event of the user."""
GRAZING = 1e-9
"""Speed of a scalar, as part of the fastest motion, below which it only touches zero."""
ENDED = 1e-8
"""Part of the size within which a pair of outlines is at its end."""
SLIDES = 1e-6
"""Part of a normal force by which the friction of what slides may be other than the coefficient says."""
ALIKE = 1e-6
"""Part of the duration, or of the size, that numbers may move events or contacts apart by, changed by their sizes."""


@dataclass(frozen=True)
class Guard:
    """One scalar that falls through zero at an event."""

    what: str
    name: str
    """The contact's, or that of the event of the user."""
    row: int = -1
    """Row of the gap, or of the way."""
    joint: int = -1
    """Place of the contact among the packed joints."""
    others: tuple[tuple[int, float], ...] = ()
    """Contacts that rest beside it by no friction of their own and slide with it: place, sign of the multiplier."""
    event: Any = None


@dataclass(frozen=True)
class End:
    """Tangents at the end of a stretch between events."""

    q: np.ndarray
    """(P, 3 nb) q', as v'."""
    v: np.ndarray
    lam: np.ndarray
    """(P, m) lam'."""
    pace: np.ndarray
    """(m,) how fast multipliers of the motion itself change (1/s)."""
    changes: Left
    """How the equations change with the numbers at the held motion, (P, 2, m): at its first and last node."""


def guards_of(packed: Packed, along: Along, row: int, struck: Sequence[str]) -> list[Guard]:
    """The scalars that fell through zero between row ``row`` of a simulation and the next; ``struck``: by impacts."""
    met: list[Guard] = []
    others: list[Guard] = []
    ended: list[Guard] = []
    states = {k: (_state(packed, along, k, row), _state(packed, along, k, row + 1)) for k, _ in contacts_of(packed)}
    beside = tuple(
        (k, float(np.sign(along.lam[row + 1, packed.rows_of(k)[1]])))
        for k, (before, after) in states.items()
        if before == RESTS and after in SLIDING
    )
    for k, joint in contacts_of(packed):
        before, after = states[k]
        gap = packed.rows_of(k).start
        if before == OPEN and (joint.name in struck or after != OPEN):
            if joint.kind.always_closed:
                others.append(Guard(RATE, joint.name, gap, k))
            else:
                met.append(Guard(GAP, joint.name, gap, k))
        elif before in SLIDING and after in {*SLIDING, STICKS} - {before}:
            others.append(Guard(RATE, joint.name, gap + 1, k))
        elif before == STICKS and after in SLIDING:
            others.append(Guard(SLIP, joint.name, gap + 1, k, beside))
        elif before != OPEN and after == OPEN and _has_ended(packed, along, row, gap):
            ended.append(Guard(ROOM, joint.name, gap, k))
    return ended or met or others  # what else closes or opens there follows from the end of a pair


def _has_ended(packed: Packed, along: Along, row: int, gap: int) -> bool:
    """Return True if the pair of a row of outlines is at its end."""
    if along.pairs is None:
        return False
    return abs(room_at(packed, along.t[row], along.q[row], along.pairs[row], gap)) <= ENDED * packed.size


OPEN, RESTS, STICKS = "open", "rests", "sticks"
SLIDING = ("slides ahead", "slides back")


def contacts_of(packed: Packed) -> list[tuple[int, Joint]]:
    """The contacts and their places among the joints."""
    places = range(len(packed.joints) - packed.contacts, len(packed.joints))
    return [(k, packed.joints[k]) for k in places if isinstance(packed.joints[k].kind, ContactKind)]


def _state(packed: Packed, along: Along, k: int, row: int) -> str:
    """Return what contact ``k`` does at a row: it rests where it needs no friction."""
    assert along.held is not None
    rows = packed.rows_of(k)
    gap = rows.start
    if not along.held[row, gap]:
        return OPEN
    if len(rows) == 1:
        return RESTS
    if along.held[row, gap + 1]:
        return STICKS
    push = along.lam[row, gap + 1] * along.lam[row, gap]
    return RESTS if push == 0.0 else SLIDING[0] if push > 0.0 else SLIDING[1]


def ways_of(packed: Packed, along: Along) -> tuple[list[tuple[int, int]], list[int]]:
    """Rows of sliding and of the gap whose force makes their friction, along a stretch; and rows of friction at rest
    that others hold with theirs.
    """
    assert along.held is not None
    sliding: list[tuple[int, int]] = []
    shared: list[int] = []
    for k, joint in contacts_of(packed):
        rows = packed.rows_of(k)
        gap = rows.start
        if len(rows) == 1 or not along.held[0, gap] or along.held[0, gap + 1] or not along.lam[:, gap + 1].any():
            continue
        push, normal = np.abs(along.lam[:, gap + 1]), np.abs(along.lam[:, gap])
        if np.abs(push - joint.params["friction"] * normal).max() <= SLIDES * normal.max():
            sliding.append((gap + 1, gap))
        else:
            shared.append(gap + 1)
    return sliding, shared


def unshared(terms: Terms, along: Along, compact: np.ndarray, ways: Sequence[int]) -> np.ndarray:
    """(T, m) multipliers of a stretch where the rows that hold carry what friction at rest in ``ways`` shares."""
    assert along.held is not None
    jac, lam, held = terms.packed.spread(compact), along.lam.copy(), np.flatnonzero(along.held[0])
    rows = list(ways)
    force = np.einsum("twn,tw->tn", jac[:, rows], lam[:, rows])
    lam[:, held] += np.einsum("thn,tn->th", np.linalg.pinv(jac[:, held].transpose(0, 2, 1), rcond=1e-9), force)
    lam[:, rows] = 0.0
    return lam


def share_least(terms: Terms, along: Along, compact: np.ndarray, rank: int) -> tuple[np.ndarray, np.ndarray]:
    """Return accelerations (T, 3 nb) and the least multipliers (T, m) of a stretch whose rows repeat each other.

    ``rank`` of the rows that hold are independent. A simulation shares loads among a choice of them, which grow without
    bound near poses where that choice alone is singular. With J = U S V^T of these rows and Z their null space,

        a = J^+ gamma + Z u,   Z^T M Z u = Z^T (Q - M J^+ gamma),   lam = J^T^+ (Q - M a)
    """
    assert along.held is not None
    packed, held, (_, gamma, _) = terms.packed, np.flatnonzero(along.held[0]), terms.rows(along)
    load, mass = (terms.forces(along, compact) + terms.weight)[:, 3:], terms.inertia[3:]
    size, unit = packed.column_scale(), packed.row_scale()[held]
    left, singular, right = np.linalg.svd(packed.spread(compact)[:, held] * unit[:, None] * size)
    across, onto = left[:, :, :rank].transpose(0, 2, 1) / singular[:, :rank, None], right[:, :rank]
    free = right[:, rank:] * size
    a = size * np.einsum("tkn,tkr,tr->tn", onto, across, gamma[:, held] * unit)
    pushed = np.einsum("tfn,tn->tf", free, load - mass * a)
    a += np.einsum(
        "tfn,tf->tn", free, np.linalg.solve((free * mass) @ free.transpose(0, 2, 1), pushed[..., None])[..., 0]
    )
    lam = np.zeros_like(along.lam)
    lam[:, held] = unit * np.einsum("tkr,tkn,tn->tr", across, onto, size * (load - mass * a))
    return np.pad(a, ((0, 0), (3, 0))), lam


def times_moved(
    terms: Terms, every: Sequence[Variants], along: Along, row: int, guards: Sequence[Guard], tangent: End
) -> np.ndarray:
    """(P,) how the time of an event changes with each number (s by its unit), from row ``row`` of a motion, before it.

    Raises ModelError where there is no derivative.
    """
    name, t, here = terms.packed.name, float(along.t[row]), along.take(slice(row, row + 1))
    fastest, span = 1.0 / per_scales(terms, along)[1], float(along.t[-1] - along.t[0])
    known: list[tuple[Guard, np.ndarray]] = []
    for guard in guards:
        change, pace, unit = _changes(terms, every, here, span, guard, tangent)
        if abs(pace) > GRAZING * fastest * unit:
            known.append((guard, -change / pace))
        elif guard.what != GAP or len(guards) == 1:
            raise ModelError(
                f"{name}: at t = {t:.6g} s '{guard.name}' is met without speed, so that a small change may leave it "
                "out: there is no derivative beyond it"
            )
        else:  # struck by what another contact passes on
            for variants, moved in zip(every, change, strict=True):
                if abs(moved) * variants.size > ALIKE * unit:
                    raise ModelError(_apart(name, t, variants.number.name, [guard.name, guards[0].name]))
    if not known:
        return np.zeros(len(every))
    times = np.array([own for _, own in known])
    sizes = np.array([variants.size for variants in every])
    apart = np.ptp(times, axis=0)
    off = apart * sizes > ALIKE * np.maximum(span, np.abs(times).max(axis=0) * sizes)
    if off.any():
        raise ModelError(_apart(name, t, every[int(np.argmax(off))].number.name, [guard.name for guard, _ in known]))
    return times[0]


def _apart(mechanism: str, t: float, number: str, names: Sequence[str]) -> str:
    several = " and ".join(f"'{name}'" for name in dict.fromkeys(names))
    return (
        f"{mechanism}: no derivative by '{number}' beyond t = {t:.6g} s: {several} are met at one time, and it moves "
        "one before the other, so that what follows differs from side to side. Begin a little apart from there"
    )


def _changes(
    terms: Terms, every: Sequence[Variants], here: Along, span: float, guard: Guard, tangent: End
) -> tuple[np.ndarray, float, float]:
    """(P,) dg + g_p of a guard, dg/dt, and what makes its values sizes, rad or parts of the forces."""
    packed, row = terms.packed, guard.row
    if guard.what == USER:
        return (*_changes_of_user(terms, every, here, span, guard.event, tangent), 0.0)
    if guard.what == SLIP:
        return (*_changes_of_friction(terms, every, here, span, guard, tangent), 0.0)
    if guard.what == ROOM:
        return (*_changes_of_room(terms, every, here, span, row, tangent), packed.size)
    unit, part = 1.0 / float(packed.row_scale()[row]), "position" if guard.what == GAP else "velocity"
    if guard.what == GAP:
        change = tangent.q[:, 3:] @ packed.spread(terms.rows(here)[2])[0, row]
        pace = float(terms.left(here).velocity[0, row])
    else:
        change = rates_along(terms, here, tangent.q, tangent.v)[:, row]
        pace = float(terms.left(here).acceleration[0, row])
    return change + getattr(tangent.changes, part)[:, -1, row], pace, unit


def rates_along(terms: Terms, here: Along, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(P, m) how J v - nu changes along q', v' (P, 3 nb) at one row of a motion."""
    return np.array(
        [
            along_direction(terms, here, dq[None], dv[None], SECOND, REACH).velocity[0]
            for dq, dv in zip(q, v, strict=True)
        ]
    )


def _changes_of_friction(
    terms: Terms, every: Sequence[Variants], here: Along, span: float, guard: Guard, tangent: End
) -> tuple[np.ndarray, float]:
    q, v, lam, dt = here.q, here.v, here.lam, INSTANT * max(span, 1e-9)

    def left(of: Terms, sign: float, dq: np.ndarray, dlam: np.ndarray) -> float:
        return _friction_left(of, replace(here, q=q + sign * dq, lam=lam + sign * dlam), guard)

    changes = np.zeros(len(every))
    for p, (dq, dv, variants) in enumerate(zip(tangent.q, tangent.v, every, strict=True)):
        pushed = float(np.abs(tangent.lam[p]).max()) / (float(np.abs(lam).max()) or 1.0)
        h = _reach(terms, here, dq, dv, pushed)
        ahead, behind = (left(terms, sign * h, dq, tangent.lam[p]) for sign in (1.0, -1.0))
        changes[p] = (ahead - behind) / (2 * h)
        changes[p] += float(variants.slope(lambda variant: np.array(_friction_left(variant.terms, here, guard))))
    later, sooner = (left(terms, sign * dt, v[0], tangent.pace) for sign in (1.0, -1.0))
    return changes, (later - sooner) / (2 * dt)


def _changes_of_room(
    terms: Terms, every: Sequence[Variants], here: Along, span: float, row: int, tangent: End
) -> tuple[np.ndarray, float]:
    assert here.pairs is not None
    t, q, pairs, dt = float(here.t[0]), here.q[0], here.pairs[0], INSTANT * max(span, 1e-9)
    changes = np.zeros(len(every))
    for p, (dq, dv, variants) in enumerate(zip(tangent.q, tangent.v, every, strict=True)):
        h = _reach(terms, here, dq, dv)
        ahead, behind = (room_at(terms.packed, t, q + sign * h * dq, pairs, row) for sign in (1.0, -1.0))
        changes[p] = (ahead - behind) / (2 * h)
        changes[p] += float(variants.slope(lambda variant: np.array(room_at(variant.terms.packed, t, q, pairs, row))))
    step = dt * here.v[0]
    later, sooner = (room_at(terms.packed, t + s * dt, q + s * step, pairs, row) for s in (1.0, -1.0))
    return changes, (later - sooner) / (2 * dt)


def _friction_left(terms: Terms, here: Along, guard: Guard) -> float:
    """mu_s N - |T| of a contact (N), where those that slide with it carry as much as they can.

    One row holds them all: what another of them carries, t, takes C t off the multipliers of the rows that hold, its
    own row being C^T of these.
    """
    packed, lam = terms.packed, here.lam[0]
    assert here.held is not None
    held = np.flatnonzero(here.held[0])
    known = lam[held]
    if guard.others:
        jac = packed.spread(terms.rows(here)[2])[0]
        places = [k for k, _ in guard.others]
        gaps = packed.first_row[places]
        most = np.array([sign * packed.joints[k].params["static_friction"] for k, sign in guard.others])
        share = np.linalg.lstsq(jac[held].T, jac[gaps + 1].T, rcond=None)[0]
        pressed = share[np.searchsorted(held, gaps)]
        known = known - share @ np.linalg.solve(np.eye(len(most)) - most[:, None] * pressed, -most * lam[gaps])
    way, gap = np.searchsorted(held, [guard.row, guard.row - 1])
    return float(-packed.joints[guard.joint].params["static_friction"] * known[gap] - abs(known[way]))


def _reach(terms: Terms, here: Along, dq: np.ndarray, dv: np.ndarray, pushed: float = 0.0) -> float:
    """How many times a tangent (3 nb,) goes as far as ``REACH``; ``pushed``: by what part forces change along it."""
    per_size, per_speed = per_scales(terms, here)
    far = max(float(np.abs(dq * per_size).max()), float(np.abs(dv * per_size).max()) * per_speed, pushed)
    return REACH / far if far > 0.0 else REACH


def _changes_of_user(
    terms: Terms, every: Sequence[Variants], here: Along, span: float, event: Any, tangent: End
) -> tuple[np.ndarray, float]:
    packed, dt = terms.packed, INSTANT * max(span, 1e-9)
    t, q, v, a = float(here.t[0]), here.q[0], here.v[0], here.a[0]

    def value(of: Any, packed: Packed, t: float, q: np.ndarray, v: np.ndarray) -> float:
        return float(of.value_at(Moment(packed, t, q, v)))

    changes = np.zeros(len(every))
    for p, (dq, dv, variants) in enumerate(zip(tangent.q, tangent.v, every, strict=True)):
        h = _reach(terms, here, dq, dv)
        ahead, behind = (value(event, packed, t, q + s * h * dq, v + s * h * dv) for s in (1.0, -1.0))
        changes[p] = (ahead - behind) / (2 * h)
        changes[p] += float(
            variants.slope(
                lambda variant: np.array(value(variant.events.get(event.name, event), variant.terms.packed, t, q, v))
            )
        )
    later, sooner = (value(event, packed, t + s * dt, q + s * dt * v, v + s * dt * a) for s in (1.0, -1.0))
    return changes, (later - sooner) / (2 * dt)


def refuse_contact_at_start(
    terms: Terms, every: Sequence[Variants], along: Along, q: np.ndarray, v: np.ndarray, changes: Left,
    events: Sequence[Happening],
) -> None:  # fmt: skip
    """Raise ModelError for a number that moves a contact which is closed at the start, and for an impact there.

    ``q`` and ``v`` (P, 3 nb) are q' and v' at the start of a motion with ``events``; ``changes``: as those of End.
    """
    packed, here, scale = terms.packed, along.take(slice(0, 1)), terms.packed.row_scale()
    struck = next((event.name for event in events if event.what == "impact" and event.time <= along.t[0]), None)
    if struck is not None:
        raise ModelError(
            f"{packed.name}: derivatives of a motion that begins with an impact of '{struck}' are not known: begin a "
            "little before it, or with the velocities after it"
        )
    assert here.held is not None
    rates, fastest = None, 1.0 / per_scales(terms, along)[1]
    for k, joint in contacts_of(packed):
        gap = packed.rows_of(k).start
        if not here.held[0, gap]:
            continue
        moved = q[:, 3:] @ packed.spread(terms.rows(here)[2])[0, gap] + changes.position[:, 0, gap]
        if rates is None:
            rates = rates_along(terms, here, q, v)
        faster = rates[:, gap] + changes.velocity[:, 0, gap]
        for p, variants in enumerate(every):
            leaves = not joint.kind.always_closed and abs(moved[p]) * scale[gap] * variants.size > ALIKE
            hastens = abs(faster[p]) * scale[gap] * variants.size > ALIKE * fastest
            if leaves or hastens:
                raise ModelError(
                    f"{packed.name}: no derivative by '{variants.number.name}': contact '{joint.name}' is closed at "
                    "the start, and a change of this number opens it to one side and drives it in to the other. Begin "
                    "a little apart, or change numbers together by build= so that it stays closed"
                )
