"""Events of the user in space: a scalar of the motion, and what happens where it passes zero."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from mbsd.base.arguments import checked
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.event import Event
from mbsd.model.laws.function import checked_pulses
from mbsd.spatial.model.body import Body, Fixing, Marker
from mbsd.spatial.model.mechanism import Model, own_body


@checked
def event(
    m: Model, name: str, value: Callable[..., float], direction: int = 0, terminal: bool = False,
    action: Callable[..., object] | None = None, shortest: float | None = None,
    frames: Fixing | Sequence[Fixing] = (),
) -> Event:  # fmt: skip
    """Monitor a scalar: an event is where ``value(t, moment)`` passes zero.

    It rises through zero with ``direction`` 1, falls with -1; 0 means both. ``moment`` shows the motion now
    (mbsd/spatial/dynamics/moment.py). ``terminal`` ends the simulation there; ``action`` is called with the moment and
    may change velocities. ``shortest`` (s): how long the shortest thing in the scalar lasts, for one with pulses.

    With ``frames``, bodies and markers, the functions get numbers and may be compiled with numba.njit:
    ``value(t, q, v)``, with place and Euler parameters of each frame in turn, 7 numbers a frame, and velocity and
    angular velocity, 6 numbers (m, rad/s; world axes). ``action(t, q, v)`` then gives new velocities, 6 numbers a
    frame. Raises ModelError for what is none of these.
    """
    what = f"{m.name}: event '{name}'"
    m.refuse_name(name, "event", m.events)
    given: Any = (frames,) if isinstance(frames, Body | Marker | str) else frames
    if not isinstance(given, Sequence) or not all(isinstance(frame, Body | Marker | str) for frame in given):
        raise ModelError(f"{what}: frames are {shown(frames)}; give bodies and markers: frames=(arm, tip)")
    owners = [own_body(m, frame.body if isinstance(frame, Marker) else frame, what) for frame in given]
    seen: Any = tuple(f if isinstance(f, Marker) else body.origin for f, body in zip(given, owners, strict=True))
    for word, function in (("value", value), ("action", action)):
        if not callable(function) and not (word == "action" and function is None):
            raise ModelError(f"{what}: {word} is {shown(function)}; it must be a function")
        if not seen and type(function).__module__.startswith("numba."):
            raise ModelError(
                f"{what}: {word} is compiled with numba, and compiled functions cannot take a moment. Name the bodies "
                "and markers it needs, frames=(arm, tip), and write it as value(t, q, v) of their numbers"
            )
    if direction not in (-1, 0, 1):
        raise ModelError(f"{what}: direction is {shown(direction)}; it must be 1, -1 or 0")
    names = [body.name for body in owners]
    if action is not None and ("ground" in names or len(set(names)) < len(names)):
        raise ModelError(f"{what}: its action gives velocities to frames; take each moving body once, not ground")
    pulses = checked_pulses(what, (), shortest)[1]
    made = m.events[name] = Event(name, value, direction, bool(terminal), action, pulses, seen)
    return made
