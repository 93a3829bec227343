"""Events of the user added to a mechanism: what is given is checked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.model.body import Body, Marker
from mbsd.model.event import Event
from mbsd.model.joint import Joint
from mbsd.model.laws.function import checked_pulses
from mbsd.model.mechanism import Model, own_body


def checked_event(
    m: Model,
    name: str,
    value: Any,
    direction: Any,
    terminal: bool,
    action: Any,
    shortest: float | None,
    frames: Body | Marker | Sequence[Body | Marker],
    releases: str | Joint | Sequence[str | Joint],
) -> Event:
    """The event that these arguments of :meth:`mbsd.mechanism.Mechanism.event` say. Raises ModelError."""
    event = f"{m.name}: event '{name}'"
    seen = _frames(m, event, frames)
    for what, function in (("value", value), ("action", action)):
        if what == "action" and function is None:
            continue
        if not callable(function):
            raise ModelError(f"{event}: {what} is {shown(function)}; it must be a function")
        if not seen and type(function).__module__.startswith("numba."):
            raise ModelError(
                f"{event}: {what} is compiled with numba, which knows no moment; say of which bodies and markers it "
                "gets the numbers, frames=(arm, tip), and take them as value(t, q, v)"
            )
    if direction not in (-1, 0, 1):
        raise ModelError(f"{event}: direction is {shown(direction)}; it must be 1, -1 or 0")
    names = [marker.body.name for marker in seen]
    if action is not None and ("ground" in names or len(set(names)) < len(names)):
        raise ModelError(f"{event}: its action gives velocities to frames; take each moving body once, not ground")
    released = _released(m, event, releases)
    if released and terminal:
        raise ModelError(f"{event}: it ends the simulation, so nothing is released after it; leave one of them out")
    return Event(name, value, direction, bool(terminal), action, checked_pulses(event, (), shortest)[1], seen, released)


def _released(m: Model, event: str, releases: Any) -> tuple[str, ...]:
    given, known = (releases,) if isinstance(releases, str | Joint) else releases, {**m.joints, **m.drivers}
    if not isinstance(given, Sequence):
        raise ModelError(f"{event}: releases is {shown(releases)}; give names of joints: releases=('hinge', 'motor')")
    names = [joint.name if isinstance(joint, Joint) else joint for joint in given]
    for name in names:
        if not isinstance(name, str) or name not in known:
            raise ModelError(f"{event}: {no_such('joint to release', name, known)}")
    return tuple(dict.fromkeys(names))


def _frames(m: Model, event: str, frames: Any) -> tuple[Marker, ...]:
    given = (frames,) if isinstance(frames, Body | Marker | str) else frames
    if not isinstance(given, Sequence) or not all(isinstance(frame, Body | Marker | str) for frame in given):
        raise ModelError(f"{event}: frames are {shown(frames)}; give bodies and markers: frames=(arm, arm.end)")
    what = f"event of frames ({event})"
    for frame in given:
        own_body(m, frame.body if isinstance(frame, Marker) else frame, what)
    return tuple(frame if isinstance(frame, Marker) else own_body(m, frame, what).origin for frame in given)
