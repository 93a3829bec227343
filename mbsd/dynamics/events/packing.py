"""Contacts and joints that stick of a prepared run for the compiled loop, or why they do not go there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.arrays.curve_branches import CURVES
from mbsd.dynamics.events.arrays import (
    BASIS,
    CLUTCH,
    DIVIDES,
    FRICTION,
    GAP,
    GIVES,
    HOLDING,
    KINETIC,
    METHOD,
    MOST_LOOKS,
    OUTSIDE,
    PARTS,
    RELEASED,
    RESTING,
    SHIFT,
    SLIDE,
    STATIC,
    WAY,
    Contacts,
    Curves,
    Friction,
    Outside,
    Sticks,
    Wheels,
)
from mbsd.dynamics.events.bounds import NEAR as CLOSED_GAP
from mbsd.dynamics.events.bounds import ROUNDS, STILL
from mbsd.dynamics.events.laws.division import division_of
from mbsd.dynamics.events.laws.least_part import together_of
from mbsd.dynamics.events.users.packing import events_of, may_release
from mbsd.dynamics.integrators.advance import number_of
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.prepared import SHORTEST, PreparedDynamics
from mbsd.dynamics.reference.pins import with_pins
from mbsd.dynamics.reference.schur import Schur, elimination_sequence
from mbsd.dynamics.reference.sliding import sliding_for
from mbsd.dynamics.repeated_rows.packing import repeated_of
from mbsd.dynamics.state import State
from mbsd.dynamics.switches import RunContact
from mbsd.equations.relative.equation import AT, MARKER_I, MARKER_J
from mbsd.equations.relative.equation import ROW as RELATIVE_ROW
from mbsd.kinematics.limits.free_wheels import HALF, MET
from mbsd.model.event import Event
from mbsd.model.teeth import with_radii

PINS = 2
"""Pins from which on steps without contacts go their own way (reference/pins.py): a third less an evaluation."""


def contacts_of(
    ready: PreparedDynamics,
    state: State,
    events: Sequence[Event],
    longest: float,
    method: Integrator | None,
    log: bool = False,
) -> Contacts:
    """Return contacts of a run at its start, and events of the user; all are open, and all joints slide.

    ``longest``: the longest step (s). ``method``: the integrator, if there are steps. ``log``: keep impulses.
    """
    own = _places(ready)
    c, n3, rows = len(own), state.y.shape[1], len(state.lam)
    pushing = c + 2 * len(_rough(ready)) + 2 * len(ready.sticks)

    bare = _without(ready, events)
    number = None if method is None else number_of(method)
    clock = np.zeros(DIVIDES + 1)
    clock[DIVIDES] = c > 0 and _divides(ready)
    clock[METHOD] = OUTSIDE if number is None else number

    def another() -> State:
        return State(*(np.zeros_like(part) for part in state))

    return Contacts(
        np.array(own, np.int64).reshape(-1, FRICTION + 1),
        np.array(_numbers(ready)).reshape(-1, RELEASED + 1),
        clock,
        another(),
        another(),
        np.zeros((6, n3)),
        np.zeros((2, n3)),
        np.zeros((2, n3)),
        np.zeros(rows),
        np.zeros(n3),
        PARTS.copy(),
        np.zeros((c, len(PARTS))),
        np.zeros((c, n3)),
        np.zeros((c, c)),
        np.zeros((c, c)),
        np.zeros((pushing, 2 * pushing + 2)),
        np.zeros((SHIFT + 1, c)),
        np.zeros((MOST_LOOKS + 2, 6)),
        np.zeros((RESTING + 1, c), np.int64),
        *bare,
        np.zeros((2, pushing), np.int64),
        _sticks_of(ready, c, n3, rows),
        _friction_of(ready, c, n3, rows),
        _wheels_of(ready, another()),
        _curves_of(ready),
        events_of(ready, events, longest, bare[0]),
        repeated_of(ready),
        np.zeros(((ROUNDS + 1) * len(ready.switches.contacts) if log else 0, 2)),
        Outside(np.zeros(1, np.int64), np.zeros(2), np.zeros(1)),
    )


def _rough(ready: PreparedDynamics) -> list[tuple[int, RunContact]]:
    """Return contacts with friction, with their numbers among all."""
    return [(k, contact) for k, contact in enumerate(ready.switches.contacts) if contact.way is not None]


def _places(ready: PreparedDynamics) -> list[tuple[int, ...]]:
    switches, special = ready.switches, ready.packed.system.special[:, RELATIVE_ROW].tolist()

    def place(row: int, kind: int, friction: int) -> tuple[int, ...]:
        return row, *switches.place[row], kind, special.index(row) if row in special else -1, friction

    rows = [(contact.gap, CLUTCH if contact.always_closed else GAP, -1) for contact in switches.contacts]
    rows += [(contact.way or 0, SLIDE, -1) for _, contact in _rough(ready)]
    return [place(*each) for each in [*rows, *((stick.way, WAY, stick.at) for stick in ready.sticks)]]


def _numbers(ready: PreparedDynamics) -> list[tuple[float, ...]]:
    scale = ready.packed.row_scale()
    out: list[tuple[float, ...]] = []
    for contact in ready.switches.contacts:
        size = scale[contact.gap]
        near = STILL if contact.always_closed else CLOSED_GAP
        out.append((near / size, STILL / size, contact.settle, contact.restitution, size, 0.0, 0.0, 0.0, 0.0))
    ways = [(contact.way or 0, 0.0) for _, contact in _rough(ready)]
    for way, sign in [*ways, *((stick.way, 1.0) for stick in ready.sticks)]:
        still = STILL / scale[way]
        out.append((still, still, 0.0, 0.0, scale[way], 0.0, 0.0, sign, 0.0))
    return out


def _sticks_of(ready: PreparedDynamics, c: int, n3: int, rows: int) -> Sticks:
    frictions = len(ready.dynamics.loads.friction) if c else 0
    own = c if _divides(ready) or len(_rough(ready)) > 1 else 0
    return Sticks(
        np.arange(c - len(ready.sticks), c),
        np.zeros((GIVES + 1, own)),
        np.zeros((BASIS + 1, frictions)),
        np.zeros((own, rows)),
        np.zeros((2, rows)),
        np.zeros((2, n3)),
        np.zeros((frictions, n3)),
        np.zeros((frictions, rows)),
        np.zeros((own, frictions)),
        division_of(own),
        together_of(own),
    )


def _divides(ready: PreparedDynamics) -> bool:
    """Return True if joints have friction beside contacts, or contacts lose some once they slide."""
    losing = any(contact.static_friction > contact.friction for _, contact in _rough(ready))
    return losing or bool(len(ready.dynamics.loads.friction))


def _friction_of(ready: PreparedDynamics, c: int, n3: int, rows: int) -> Friction:
    """Return the friction of contacts."""
    rough, count = _rough(ready), len(ready.switches.contacts)
    way_of = {k: count + w for w, (k, _) in enumerate(rough)}
    order = [row for k in range(count) for row in ([k, way_of[k]] if k in way_of else [k])]
    number = np.zeros((len(rough), HOLDING + 1))
    number[:, KINETIC] = [contact.friction for _, contact in rough]
    number[:, STATIC] = [contact.static_friction for _, contact in rough]
    own = c if rough or len(ready.dynamics.loads.friction) else 0
    return Friction(
        np.array([k for k, _ in rough], np.int64),
        number,
        np.zeros((own, own)),
        np.array([*order, *range(len(order), c)], np.int64),
        sliding_for(np.zeros((0, 2), np.int64), n3, rows),
    )


def _wheels_of(ready: PreparedDynamics, before: State) -> Wheels:
    """Return the wheels that may run into each other."""
    pairs = ready.following.wheels.pairs
    sized = [with_radii(joint.params) for joint, _, _ in pairs]
    return Wheels(
        np.array([(i, j) for _, i, j in pairs], np.int64).reshape(-1, 2),
        np.array([MET * (params["radius_i"] + params["radius_j"]) for params in sized]),
        np.array([HALF, SHORTEST, 0.0]),
        before,
    )


def _curves_of(ready: PreparedDynamics) -> Curves:
    """Return the points on curves that cross themselves."""
    special, rows = ready.packed.system.special, ready.following.rows
    own = {(row.i, row.j) for row in rows}
    place = [
        (k, int(entry[MARKER_I]), int(entry[MARKER_J]), int(entry[AT]))
        for k, entry in enumerate(special)
        if ready.packed.specials.names[k] in CURVES and (int(entry[MARKER_I]), int(entry[MARKER_J])) in own
    ]
    numbers = ready.packed.system.numbers.copy() if rows else np.zeros(0)
    return Curves(np.array(place, np.int64).reshape(-1, 4), numbers, np.zeros(len(place)))


def _without(ready: PreparedDynamics, events: Sequence[Event]) -> tuple[Schur, np.ndarray]:
    """Return the elimination sequence and relative constraints while all contacts are open."""
    packed, schur, special = ready.packed, ready.dynamics.schur, ready.packed.system.special
    if not ready.switches.contacts and not ready.sticks:
        return schur, special
    others = int((special[:, RELATIVE_ROW] < packed.contact_rows).sum())
    first = special[:others] if (special[:others, RELATIVE_ROW] < packed.contact_rows).all() else special
    if ready.switches.spare:
        return schur, first  # rows that stand in for others are planned in it
    blocks = schur.rows[(schur.rows >= 0).any(axis=1)]
    kept = blocks[np.argsort(blocks.max(axis=1))]
    bare = elimination_sequence(packed.system.row_body, np.ascontiguousarray(kept, np.int64))
    dry, releasing = len(ready.dynamics.loads.friction) > 0, any(may_release(event) for event in events)
    if not (dry or releasing or len(first) or ready.dynamics.passes > 1):
        bare = with_pins(bare, packed.system, packed.contact_rows, PINS)
    return bare, first
