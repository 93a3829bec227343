"""The calls that build a mechanism in space, kept so that it can be changed, saved and built again.

A call is a method's name with its arguments by name; bodies, joints and forces stand in it by name, markers by body,
place and axes. A change calls all methods again on an empty model with the new numbers. So what follows from others,
such as markers at places of the world, follows the new ones; what the mechanism no longer has is left out.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TypeVar

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.base.pickled import WithFunctions
from mbsd.spatial.model.body import Body, Marker
from mbsd.spatial.model.force import Force
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.model.mechanism import Model

C = TypeVar("C", bound=type)
STARTS = ("start_near", "start_moving")
BODIES = ("body", "rod", "shaft", "disc", "ball")
BUILDING = (
    *BODIES, *STARTS, "trace", "event", "fixed", "revolute", "prismatic", "cylindrical", "planar", "spherical",
    "universal", "constant_velocity", "distance", "rod_with_fork", "point_on_line", "point_on_plane", "parallel",
    "lock", "screw", "rolling", "gear_pair", "rack_and_pinion", "belt", "differential", "spring", "torsion_spring",
    "torque", "actuator", "drag", "friction", "bushing", "contact", "tyre", "user_force", "drive_turn", "drive_slide",
    "drive_distance",
)  # fmt: skip
"""Methods whose calls are kept."""


class Named(NamedTuple):
    """A body, joint or force in a call."""

    what: str
    """body or name."""
    name: str


class Fixed(NamedTuple):
    """A marker in a call."""

    body: str
    place: tuple[float, float, float]
    axis: tuple[float, float, float]
    across: tuple[float, float, float]


@dataclass
class Call(WithFunctions):
    """One call."""

    method: str
    arguments: dict[str, Any] = field(default_factory=dict)
    """By the names of its parameters; those of ``*frames`` as a list."""

    @property
    def name(self) -> str:
        """The name of what it adds; empty for starts."""
        return self.arguments.get("name", "") if self.method not in STARTS else ""


def recorded(cls: C) -> C:
    """Return a class of models whose building methods keep their calls."""
    for name in BUILDING:
        setattr(cls, name, _keeping(name, getattr(cls, name)))
    return cls


def _keeping(name: str, method: Callable[..., Any]) -> Callable[..., Any]:
    signature = inspect.signature(method)

    @functools.wraps(method)
    def inner(*given: Any, **named: Any) -> Any:
        m = given[0]
        if m.building:  # a method that another one calls
            return method(*given, **named)
        m.building = True
        try:
            out = method(*given, **named)
        finally:
            m.building = False
        bound = signature.bind(*given, **named).arguments
        m.calls.append(Call(name, {key: _kept(value) for key, value in list(bound.items())[1:]}))
        return out

    return inner


def _kept(value: Any) -> Any:
    if isinstance(value, Body):
        return Named("body", value.name)
    if isinstance(value, Joint | Force):
        return Named("name", value.name)
    if isinstance(value, Marker):
        return Fixed(value.body.name, value.place, value.axis, value.across)
    if isinstance(value, Mapping):
        return {key: _kept(part) for key, part in value.items()}
    return type(value)(map(_kept, value)) if type(value) in (list, tuple) else value


def _given(m: Model, value: Any) -> Any:
    if isinstance(value, Named):
        return m.bodies[value.name] if value.what == "body" else value.name
    if isinstance(value, Fixed):
        return Marker(m.bodies[value.body], value.place, value.axis, value.across)
    if isinstance(value, dict):
        return {key: _given(m, part) for key, part in value.items()}
    return type(value)(_given(m, part) for part in value) if type(value) in (list, tuple) else value


def call_again(m: Model, call: Call) -> None:
    """Call a method on a model with the arguments that were kept. Raises ModelError."""
    if call.method not in BUILDING:
        raise ModelError(f"{m.name}: {no_such('method that builds', call.method, BUILDING)}")
    method = getattr(m, call.method)
    arguments = {key: _given(m, value) for key, value in call.arguments.items()}
    several = [p.name for p in inspect.signature(method).parameters.values() if p.kind is p.VAR_POSITIONAL]
    if not several:
        method(**arguments)
        return
    rest = arguments.pop(several[0], ())
    before = list(inspect.signature(method).parameters)
    first = [arguments.pop(key) for key in before[: before.index(several[0])]]
    method(*first, *rest, **arguments)


def change(m: Model, name: str, values: Mapping[str, Any]) -> None:
    """Call all methods again, that which added ``name`` with other values; ModelError changes nothing."""
    known = {call.name: call for call in m.calls if call.name and _is_there(m, call)}
    if name not in known:
        raise ModelError(f"{m.name}: {no_such('body, joint, driver, force or event', name, known)}")
    call = known[name]
    parameters = [p for p in inspect.signature(getattr(m, call.method)).parameters if p not in ("m", "name")]
    for key in values:
        if key not in parameters:
            raise ModelError(f"{m.name}: {call.method} '{name}': {no_such('argument', key, parameters)}")
    new = Call(call.method, call.arguments | {key: _kept(value) for key, value in values.items()})
    rebuild(m, [new if old is call else old for old in m.calls])


def _is_there(m: Model, call: Call) -> bool:
    """Return True if what a call added is still in the model."""
    if call.method in STARTS:
        return True
    if call.method in BODIES:
        return call.name in m.bodies
    return any(call.name in table for table in (m.joints, m.drivers, m.forces, m.events, m.traces))


def rebuild(m: Model, calls: list[Call]) -> None:
    """Build a model again by calls; its bodies stay the same objects. ModelError changes nothing."""
    new = type(m)(m.name, m.gravity)
    before = {name: dict(vars(body)) for name, body in m.bodies.items()}
    try:
        for call in calls:
            if not _is_there(m, call):
                continue
            call_again(new, call)
            if call.method in BODIES:
                own = m.bodies[call.name]
                vars(own).clear()
                vars(own).update({key: vars(new.bodies[call.name])[key] for key in Body.__dataclass_fields__})
                new.bodies[call.name] = own
    except BaseException:
        for name, fields in before.items():
            vars(m.bodies[name]).clear()
            vars(m.bodies[name]).update(fields)
        raise
    for name in ("joints", "drivers", "forces", "events", "traces", "starts", "velocities", "calls"):
        setattr(m, name, getattr(new, name))
