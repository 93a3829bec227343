"""Events of the user of a prepared run for the compiled loop, or why they do not go there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from mbsd.compiling.callback import Callback
from mbsd.compiling.jit import COMPILED
from mbsd.dynamics.events.bounds import MOST_VALUES, NEAR, PER_SHORTEST, ROUNDINGS
from mbsd.dynamics.events.moment import Moment, place_of, value_at
from mbsd.dynamics.events.users import values
from mbsd.dynamics.events.users.arrays import ACTION_FRAMES, BY_PYTHON, ITS_FRICTION, UNKNOWN, WHOLE, Events
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.schur import Schur
from mbsd.equations.joint_friction import FIRST
from mbsd.model.body import Marker
from mbsd.model.event import Event, Reaching

READY_MADE = {name: getattr(values, name) for name in ("turned", "turning", "distance")}
MOST = 20_000
"""Values of an event in one step."""


def why_not(events: Sequence[Event], longest: float) -> str | None:
    """Return why these events do not go in a batch, or None. ``longest``: the longest step (s)."""
    for event in events:
        if _looks(event, longest) > MOST:
            return f"event '{event.name}': its shortest is less than 1/{MOST // 2} of the longest step"
        for what, function in (("function", event.value), ("action", event.action)):
            if function is None or isinstance(function, Reaching):
                continue
            if not event.frames:
                return f"event '{event.name}': its {what} gets a moment, not the numbers of frames"
            if not Callback.is_machine_code(function):
                return f"event '{event.name}': its {what} is one of Python; compile it with numba.njit"
    return None


def events_of(ready: PreparedDynamics, events: Sequence[Event], longest: float, bare: Schur) -> Events:
    """Return the user's events at the start of a run, whose steps are ``longest`` (s) at most."""
    packed, frames = ready.packed, list[Marker]()
    table, number = [], []
    for event in events:
        what, first = f"{packed.name}: event '{event.name}'", len(frames)
        seen = event.value.frames if isinstance(event.value, Reaching) else event.frames
        frames += seen
        action, acting = 0, len(frames)
        if acts_in_python(event):
            action = BY_PYTHON
        elif event.action is not None:
            action = _address(ready, event.action, event.frames, 3 * len(event.frames), f"{what}: its action")
            frames += event.frames
        ends, kinds = int(event.terminal), (acting, len(frames) - acting)
        value, given = _value(ready, event, seen, what)
        table.append((value, first, given, event.direction, ends, action, *kinds))
        level = event.value.level if isinstance(event.value, Reaching) else 0.0
        number.append((0.0, level, event.shortest or 0.0, 0.0))
    most = max((len(frames) for frames in [[], *(event.frames for event in events), *_ready(events)]), default=0)
    n3, looks = len(ready.initial.q), max((_looks(event, longest) for event in events), default=0)
    return Events(
        np.array(table, np.int64).reshape(-1, ACTION_FRAMES + 1),
        np.array(number).reshape(-1, UNKNOWN + 1),
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
        first = int(packed.first_row[joint])
        frictions = np.flatnonzero(friction[:, FIRST] == first).tolist()
        for row in range(first, int(packed.first_row[joint + 1])):
            places = ready.switches.place.get(row, (-1, -1)), _place(bare, row)
            out += [
                (group, row, *places[0], *places[1], at) for at in (frictions if row == first and frictions else [-1])
            ]
    return np.array(out, np.int64).reshape(-1, ITS_FRICTION + 1)


def _place(schur: Schur, row: int) -> tuple[int, int]:
    at = np.argwhere(schur.rows == row).tolist()
    return (at[0][0], at[0][1]) if at else (-1, -1)


def _ready(events: Sequence[Event]) -> list[tuple[Marker, ...]]:
    return [event.value.frames for event in events if isinstance(event.value, Reaching)]


def _looks(event: Event, longest: float) -> int:
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
    return made.address, WHOLE


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
