"""Contacts, joints that stick, events of the user and rows that repeat others, packed for the compiled loop.

What does not go there has a reason.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from mbsd.arrays.curve_branches import CURVES
from mbsd.arrays.outline_pairs import outline_rows, siblings
from mbsd.compiling.callback import Callback
from mbsd.compiling.jit import COMPILED
from mbsd.dynamics import repeated_rows
from mbsd.dynamics.events import arrays, users
from mbsd.dynamics.events.jumps import ROUNDS
from mbsd.dynamics.events.laws.division import division_of
from mbsd.dynamics.events.laws.least_part import together_of
from mbsd.dynamics.events.moment import Moment, place_of, value_at
from mbsd.dynamics.events.user_search import MOST_VALUES, PER_SHORTEST
from mbsd.dynamics.integrators.advance import number_of
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.large import MANY_COORDINATES
from mbsd.dynamics.prepare.prepared import SHORTEST, PreparedDynamics
from mbsd.dynamics.reference.pins import with_pins
from mbsd.dynamics.reference.schur import Schur, elimination_sequence
from mbsd.dynamics.reference.sliding import sliding_for
from mbsd.dynamics.state import State
from mbsd.dynamics.switches import RunContact
from mbsd.equations.joint_friction import FIRST
from mbsd.equations.relative.equation import AT, MARKER_I, MARKER_J
from mbsd.equations.relative.equation import ROW as RELATIVE_ROW
from mbsd.kinematics.limits.free_wheels import HALF
from mbsd.kinematics.pose import held_values, mobility
from mbsd.model.body import Marker
from mbsd.model.event import Event, Reaching
from mbsd.model.outlines.contact import tuples_of
from mbsd.model.outlines.features import DEEPEST, circle_around
from mbsd.model.outlines.geometry import Corner, size_of

NEAR = 1e-11
"""Gaps below this part of the size (rad) are closed; rates below it by 1 s are zero where bodies rest."""
ROUNDINGS = ((1.0, 1.0, -1.0, -1.0), (-1.0, 1.0, 1.0, -1.0), (1.0, -1.0, 1.0), (-1.0, -1.0, 1.0, 1.0, 1.0))
"""Signs, repeated, of small changes of a state."""
STILL = 1e-9
"""Rates below this part of the size (rad) by 1 s are zero."""

HALF_DEEPEST = 0.5 * DEEPEST
"""How deep outlines may get in a step, as part of the lesser size."""

Entry = tuple[np.ndarray, tuple[int, ...]]
"""An array and an index in it."""
PINS = 2
"""Pins from which on steps without contacts go their own way (reference/pins.py): a third less an evaluation."""


def contacts_of(
    ready: PreparedDynamics,
    state: State,
    events: Sequence[Event],
    longest: float,
    method: Integrator | None,
    log: bool = False,
) -> arrays.Contacts:
    """Return contacts of a run at its start, and events of the user; all are open, and all joints slide.

    ``longest``: the longest step (s). ``method``: the integrator, if there are steps. ``log``: keep impulses.
    """
    own = _places(ready)
    c, n3, rows = len(own), state.y.shape[1], len(state.lam)
    pushing = c + 2 * len(_rough(ready)) + 2 * len(ready.sticks)

    bare = _without(ready, events)
    number = None if method is None else number_of(method)
    clock = np.zeros(arrays.DIVIDES + 1)
    clock[arrays.DIVIDES] = c > 0 and _divides(ready)
    clock[arrays.METHOD] = arrays.OUTSIDE if number is None else number

    def another() -> State:
        return State(*(np.zeros_like(part) for part in state))

    return arrays.Contacts(
        np.array(own, np.int64).reshape(-1, arrays.FRICTION + 1),
        _numbers_of(ready),
        clock,
        another(),
        another(),
        np.zeros((6, n3)),
        np.zeros((2, n3)),
        np.zeros((2, n3)),
        np.zeros(rows),
        np.zeros(n3),
        arrays.PARTS.copy(),
        np.zeros((c, len(arrays.PARTS))),
        np.zeros((c, n3)),
        np.zeros((c, c)),
        np.zeros((c, c)),
        np.zeros((pushing, 2 * pushing + 2)),
        np.zeros((arrays.SHIFT + 1, c)),
        np.zeros((arrays.MOST_LOOKS + 2, 6)),
        np.zeros((arrays.STRUCK + 1, c), np.int64),
        *bare,
        np.zeros((2, pushing), np.int64),
        _sticks_of(ready, c, n3, rows),
        _friction_of(ready, c, n3, rows),
        _wheels_of(ready, another()),
        _curves_of(ready),
        events_of(ready, events, longest, bare[0]),
        repeated_of(ready),
        np.zeros(((ROUNDS + 1) * len(ready.switches.contacts) if log else 0, 2)),
        arrays.Outside(np.zeros(1, np.int64), np.zeros(2), np.zeros(1)),
        *_outlines_of(ready),
    )


def _rough(ready: PreparedDynamics) -> list[tuple[int, RunContact]]:
    """Return contacts with friction, with their numbers among all."""
    return [(k, contact) for k, contact in enumerate(ready.switches.contacts) if contact.way is not None]


def _places(ready: PreparedDynamics) -> list[tuple[int, ...]]:
    switches, special = ready.switches, ready.packed.system.special[:, RELATIVE_ROW].tolist()

    def place(row: int, kind: int, friction: int) -> tuple[int, ...]:
        return row, *switches.place[row], kind, special.index(row) if row in special else -1, friction

    rows = [(contact.gap, arrays.CLUTCH if contact.always_closed else arrays.GAP, -1) for contact in switches.contacts]
    rows += [(contact.way or 0, arrays.SLIDE, -1) for _, contact in _rough(ready)]
    return [place(*each) for each in [*rows, *((stick.way, arrays.WAY, stick.at) for stick in ready.sticks)]]


def _numbers_of(ready: PreparedDynamics) -> np.ndarray:
    contacts, n = ready.switches.contacts, len(ready.switches.contacts)
    ways = [(contact.way or 0, 0.0) for _, contact in _rough(ready)]
    ways += [(stick.way, 1.0) for stick in ready.sticks]
    scale = ready.packed.row_scale()[[*(contact.gap for contact in contacts), *(way for way, _ in ways)]]
    number = np.zeros((len(scale), arrays.RELEASED + 1))
    number[:, arrays.SCALE] = scale
    number[:, arrays.NEAR] = number[:, arrays.REST] = STILL / scale
    gaps = [k for k, contact in enumerate(contacts) if not contact.always_closed]
    number[gaps, arrays.NEAR] = NEAR / scale[gaps]
    number[:n, arrays.SETTLE] = [contact.settle for contact in contacts]
    for argument, column in arrays.ARGUMENTS.items():
        number[:n, column] = [contact.given(argument) for contact in contacts]
    number[n:, arrays.SIGN] = [sign for _, sign in ways]
    return number


def entries_of(ready: PreparedDynamics, contacts: arrays.Contacts, name: str) -> dict[str, Entry]:
    """Return array and index of each number of a contact of the user, by its argument."""
    k, contact = next((k, own) for k, own in enumerate(ready.switches.contacts) if own.name == name)
    out: dict[str, Entry] = {argument: (contacts.number, (k, at)) for argument, at in arrays.ARGUMENTS.items()}
    if contact.sliding >= 0:
        friction = contacts.friction.number
        out |= {argument: (friction, (contact.sliding, at)) for argument, at in arrays.FRICTION_ARGUMENTS.items()}
    return out


def _sticks_of(ready: PreparedDynamics, c: int, n3: int, rows: int) -> arrays.Sticks:
    frictions = len(ready.dynamics.loads.friction) if c else 0
    own = c if _divides(ready) or len(_rough(ready)) > 1 else 0
    return arrays.Sticks(
        np.arange(c - len(ready.sticks), c),
        np.zeros((arrays.GIVES + 1, c)),
        np.zeros((arrays.BASIS + 1, frictions)),
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
    losing = any(contact.given("static_friction") > contact.friction for _, contact in _rough(ready))
    return losing or bool(len(ready.dynamics.loads.friction))


def _friction_of(ready: PreparedDynamics, c: int, n3: int, rows: int) -> arrays.Friction:
    """Return the friction of contacts."""
    rough, count = _rough(ready), len(ready.switches.contacts)
    way_of = {k: count + w for w, (k, _) in enumerate(rough)}
    order = [row for k in range(count) for row in ([k, way_of[k]] if k in way_of else [k])]
    number = np.zeros((len(rough), arrays.HOLDING + 1))
    for argument, column in arrays.FRICTION_ARGUMENTS.items():
        number[:, column] = [contact.given(argument) for _, contact in rough]
    return arrays.Friction(
        np.array([k for k, _ in rough], np.int64),
        number,
        np.zeros((c, c)),
        np.array([*order, *range(len(order), c)], np.int64),
        sliding_for(np.zeros((0, 2), np.int64), n3, rows),
    )


def _wheels_of(ready: PreparedDynamics, before: State) -> arrays.Wheels:
    """Return the wheels that may run into each other."""
    wheels = ready.following.wheels
    return arrays.Wheels(
        np.array([(i, j) for _, i, j in wheels.pairs], np.int64).reshape(-1, 2),
        np.array(wheels.near, float),
        np.array([HALF, SHORTEST, 0.0]),
        before,
    )


def _curves_of(ready: PreparedDynamics) -> arrays.Curves:
    """Return the points on curves that cross themselves."""
    special, rows = ready.packed.system.special, ready.following.rows
    own = {(row.i, row.j) for row in rows}
    place = [
        (k, int(entry[MARKER_I]), int(entry[MARKER_J]), int(entry[AT]))
        for k, entry in enumerate(special)
        if ready.packed.specials.names[k] in CURVES and (int(entry[MARKER_I]), int(entry[MARKER_J])) in own
    ]
    numbers = ready.packed.system.numbers.copy() if rows else np.zeros(0)
    return arrays.Curves(np.array(place, np.int64).reshape(-1, 4), numbers, np.zeros(len(place)))


def _outlines_of(ready: PreparedDynamics) -> tuple[np.ndarray, ...]:
    """Return the rows of outlines, scratch for their pairs, and the pairs of bodies with circles around them."""
    packed, known = ready.packed, {contact.gap: k for k, contact in enumerate(ready.switches.contacts)}
    rows = outline_rows(packed)
    place = [(known[row.gap], row.relative, row.way, other) for row, other in zip(rows, siblings(rows), strict=True)]
    pairs: dict[Any, tuple[list[int], list[float]]] = {}
    for k, row in enumerate(rows):
        ends = [
            (m, tuples_of(row.joint.params[key])) for m, key in ((row.joint.i, "outline_i"), (row.joint.j, "outline_j"))
        ]
        key = frozenset((marker.body.name, corners) for marker, corners in ends)
        if key not in pairs:
            bodies = [packed.body_names.index(marker.body.name) for marker, _ in ends]
            circles = [_circle_on(packed.com[b], *end) for b, end in zip(bodies, ends, strict=True)]
            least = min(size_of(corners) for _, corners in ends)
            pairs[key] = [*bodies, k, k], [*circles[0], *circles[1], HALF_DEEPEST * least]
        pairs[key][0][3] = k + 1
    swept = np.array([where for where, _ in pairs.values()], np.int64).reshape(-1, 4)
    return (
        np.array(place, np.int64).reshape(-1, 4), np.zeros(len(place)), swept,
        np.array([numbers for _, numbers in pairs.values()], float).reshape(-1, 7),
    )  # fmt: skip


def _circle_on(com: np.ndarray, marker: Marker, corners: tuple[Corner, ...]) -> tuple[float, float, float]:
    """Return centre, from the centre of mass, and radius of a circle around an outline about a marker (m)."""
    x, y, radius = circle_around(corners)
    c, s = math.cos(marker.angle), math.sin(marker.angle)
    return marker.x + c * x - s * y - float(com[0]), marker.y + s * x + c * y - float(com[1]), radius


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


READY_MADE = {name: getattr(users, name) for name in ("turned", "turning", "distance")}
MOST = 20_000
"""Values of an event in one step."""


def why_not_compiled(events: Sequence[Event], longest: float) -> str | None:
    """Return why these events do not go in a batch, or None. ``longest``: the longest step (s)."""
    for event in events:
        if looks_of(event, longest) > MOST:
            return f"event '{event.name}': its shortest is less than 1/{MOST // 2} of the longest step"
        for what, function in (("function", event.value), ("action", event.action)):
            if function is None or isinstance(function, Reaching):
                continue
            if not event.frames:
                return f"event '{event.name}': its {what} gets a moment, not the numbers of frames"
            if not Callback.is_machine_code(function):
                return f"event '{event.name}': its {what} is one of Python; compile it with numba.njit"
    return None


def events_of(ready: PreparedDynamics, events: Sequence[Event], longest: float, bare: Schur) -> users.Events:
    """Return the user's events at the start of a run, whose steps are ``longest`` (s) at most."""
    packed, frames = ready.packed, list[Marker]()
    table, number = [], []
    for event in events:
        what, first = f"{packed.name}: event '{event.name}'", len(frames)
        seen = event.value.frames if isinstance(event.value, Reaching) else event.frames
        frames += seen
        action, acting = 0, len(frames)
        if acts_in_python(event):
            action = users.BY_PYTHON
        elif event.action is not None:
            action = _address(ready, event.action, event.frames, 3 * len(event.frames), f"{what}: its action")
            frames += event.frames
        ends, kinds = int(event.terminal), (acting, len(frames) - acting)
        value, given = _value(ready, event, seen, what)
        table.append((value, first, given, event.direction, ends, action, *kinds))
        level = event.value.level if isinstance(event.value, Reaching) else 0.0
        number.append((0.0, level, event.shortest or 0.0, 0.0))
    most = max((len(frames) for frames in [[], *(event.frames for event in events), *_ready(events)]), default=0)
    n3, looks = len(ready.initial.q), max((looks_of(event, longest) for event in events), default=0)
    return users.Events(
        np.array(table, np.int64).reshape(-1, users.ACTION_FRAMES + 1),
        np.array(number).reshape(-1, users.UNKNOWN + 1),
        np.full(len(events) + (len(packed.joints) if any(map(acts_in_python, events)) else 0), np.inf),
        _release(ready, events, bare),
        np.array([packed.body_names.index(marker.body.name) for marker in frames], np.int64),
        np.array([_arm(ready, marker) for marker in frames]).reshape(-1, 3),
        np.zeros(max(6 * most, 2 * n3) if events else 0),
        np.zeros(max(3 * most, 1)),
        np.array([signs[0] * NEAR for signs in ROUNDINGS]),
        _away(ready),
        np.array([ready.end - ready.start]),
        np.zeros((2, n3)),
        np.zeros(n3),
        np.zeros(looks),
        np.zeros(looks),
        np.zeros((2, looks)),
        np.zeros((2, looks)),
        np.zeros((2, looks), np.int64),
        np.zeros(len(events), np.int64),
    )


def acts_in_python(event: Event) -> bool:
    """Return True if the action of an event is a Python function, which may release any joint."""
    return event.action is not None and not Callback.is_machine_code(event.action)


def may_release(event: Event) -> bool:
    """Return True if an event may release joints."""
    return bool(event.releases) or acts_in_python(event)


def _release(ready: PreparedDynamics, events: Sequence[Event], bare: Schur) -> np.ndarray:
    """Return rows of all joints that events release; ``bare``: the sequence without rows of contacts."""
    packed, friction, out = ready.packed, ready.dynamics.loads.friction, []
    names = [joint.name for joint in packed.joints]
    groups = [
        (e, joint)
        for e, event in enumerate(events)
        if not acts_in_python(event)
        for joint in map(names.index, event.releases)
    ]
    if any(map(acts_in_python, events)):
        groups += [(len(events) + joint, joint) for joint in range(len(names) - packed.contacts)]
    for group, joint in groups:
        rows = packed.rows_of(joint)
        frictions = np.flatnonzero(friction[:, FIRST] == rows.start).tolist()
        for row in rows:
            places = ready.switches.place.get(row, (-1, -1)), _place(bare, row)
            out += [
                (group, row, *places[0], *places[1], at)
                for at in (frictions if row == rows.start and frictions else [-1])
            ]
    return np.array(out, np.int64).reshape(-1, users.ITS_FRICTION + 1)


def _place(schur: Schur, row: int) -> tuple[int, int]:
    at = np.argwhere(schur.rows == row).tolist()
    return (at[0][0], at[0][1]) if at else (-1, -1)


def _ready(events: Sequence[Event]) -> list[tuple[Marker, ...]]:
    return [event.value.frames for event in events if isinstance(event.value, Reaching)]


def looks_of(event: Event, longest: float) -> int:
    """Return room for the values of an event in one step."""
    asked = math.ceil(PER_SHORTEST * longest / event.shortest) if event.shortest else 0
    return 16 + max(MOST_VALUES, asked)


def _value(ready: PreparedDynamics, event: Event, frames: Sequence[Marker], what: str) -> tuple[int, int]:
    """Return the address of the function of an event, and how many frames it gets."""
    packed, value = ready.packed, event.value
    if isinstance(value, Reaching):
        if COMPILED:
            return READY_MADE[value.measured.__name__].address, len(frames)
        return _address(ready, value.measured, frames, 1, what), len(frames)
    if Callback.is_machine_code(value):
        return _address(ready, value, frames, 1, f"{what}: its function"), len(frames)

    def watched(t: float, q: np.ndarray, v: np.ndarray) -> float:
        return value_at(packed, event, Moment(packed, t, q, v))

    size = len(ready.initial.q)
    made = packed.specials.callback(f"{what}: its function", lambda name: Callback(watched, (size, size), 1, name))
    return made.address, users.WHOLE


def _address(ready: PreparedDynamics, function: Any, frames: Sequence[Marker], outputs: int, what: str) -> int:
    parts = 3 * len(frames), 3 * len(frames)
    return ready.packed.specials.callback(what, lambda name: Callback(function, parts, outputs, name)).address


def _arm(ready: PreparedDynamics, marker: Marker) -> tuple[float, float, float]:
    x, y = ready.packed.com[ready.packed.body_names.index(marker.body.name)]
    own_x, own_y = place_of(ready.packed, marker)
    return own_x - x, own_y - y, marker.angle


def _away(ready: PreparedDynamics) -> np.ndarray:
    """Return (4, 3 nb) small changes of a state."""
    sizes = np.concatenate([np.zeros(3), ready.packed.column_scale()])
    return np.array([NEAR * sizes * np.resize(signs, len(sizes)) for signs in ROUNDINGS])


WORN = 1e3
"""As mobility.BETTER where friction of joints comes from these rows: others divide the load otherwise."""


def why_too_large(ready: PreparedDynamics) -> str | None:
    """Return why a mechanism whose joints repeat others does not go in a batch, or None."""
    if ready.switches.spare or not ready.dropped:
        return None
    return f"joints repeat others in a mechanism of {ready.packed.coordinates} coordinates; {MANY_COORDINATES} at most"


def repeated_of(ready: PreparedDynamics) -> repeated_rows.Repeated:
    """Return the rows of a run at its start."""
    packed, switches = ready.packed, ready.switches
    spare = set(switches.spare)
    rows = range(packed.contact_rows) if spare else []
    k, n3, scale = len(rows), len(ready.initial.q), packed.row_scale()
    number = np.zeros((k, repeated_rows.UNTIL + 1))
    number[:, repeated_rows.HELD] = [row not in spare for row in rows]
    number[:, repeated_rows.OPENED] = [row in spare for row in rows]
    number[:, repeated_rows.SCALE] = [scale[row] for row in rows]
    number[:, repeated_rows.UNTIL] = np.inf
    clock = np.zeros(repeated_rows.FOLLOWS + 1)
    clock[repeated_rows.FOLLOWS] = held_values.RANK_TOLERANCE
    clock[repeated_rows.BETTER] = WORN if len(ready.dynamics.loads.friction) else mobility.BETTER
    return repeated_rows.Repeated(
        np.array([(row, *switches.place[row]) for row in rows], np.int64).reshape(-1, 3),
        number,
        clock,
        np.concatenate([np.zeros(3), packed.column_scale()]) if k else np.zeros(0),
        np.zeros((k, n3)),
        np.zeros((k, k)),
        np.zeros((k, k)),
        np.zeros((k, k)),
        np.zeros((2, k)),
        np.zeros((2, k), np.int64),
    )


def opened(repeated: repeated_rows.Repeated) -> list[int]:
    """Return the rows that did not hold once, so that they might open."""
    return repeated.place[repeated.number[:, repeated_rows.OPENED] > 0.0, repeated_rows.ROW].tolist()
