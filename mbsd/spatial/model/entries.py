"""Entries of a model in space: joints and drivers with their arguments checked."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.model.laws import Motion
from mbsd.model.laws.function import Function
from mbsd.spatial.model.body import Direction, Fixing, Marker, Place, place_given, refuse_parallel
from mbsd.spatial.model.force import Force, ForceKind
from mbsd.spatial.model.joint import Joint, JointKind
from mbsd.spatial.model.mechanism import Model, own_body
from mbsd.spatial.model.rotation import frame

Law = Motion | Callable[[float], float]


def markers_given(
    m: Model, name: str, first: Fixing, second: Fixing, at: Place | None, axes: np.ndarray | None
) -> tuple[Marker, Marker]:
    """Return the markers of a joint: given, or on two bodies at a place of the world in the design pose.

    ``axes`` (3, 3) are those of the world that both get. Raises ModelError.
    """
    return force_markers(m, f"{m.name}: joint '{name}'", first, second, at, axes)


def force_markers(
    m: Model, what: str, first: Fixing, second: Fixing, at: Place | None, axes: np.ndarray | None
) -> tuple[Marker, Marker]:
    """Return the markers of what acts between two bodies, as :func:`markers_given`; ``what`` names it."""
    given = [part for part in (first, second) if isinstance(part, Marker)]
    if len(given) == 2:
        if at is not None or axes is not None:
            raise ModelError(f"{what} has markers and a place or an axis; a marker has both, so give one or the other")
        i, j = (own_marker(m, what, marker) for marker in given)
    elif given:
        raise ModelError(f"{what} has a marker and a body; give two markers, or two bodies with at=")
    else:
        bodies = [own_body(m, part, what) for part in (first, second)]
        if at is None:
            raise ModelError(f"{what} needs a place: at=(x, y, z) of the world in the design pose (m)")
        place, both = np.array(at, float), np.eye(3) if axes is None else axes
        i, j = (body.world_marker(place, both) for body in bodies)
    refuse_same(what, i, j)
    return i, j


def axes_given(what: str, axis: Direction | None, across: Direction | None = None) -> np.ndarray | None:
    """Return axes (3, 3), z along ``axis``, x near ``across``; None without. Raises ModelError."""
    if axis is None:
        if across is not None:
            raise ModelError(f"{what}: across is given without axis; give axis=, the direction of the joint")
        return None
    if across is not None:
        refuse_parallel(what, "axis", axis, "across", across)
    return frame(np.array(axis, float), None if across is None else np.array(across, float))


def join_about(
    m: Model, kind: JointKind, name: str, first: Fixing, second: Fixing, at: Place | None, axis: Direction | None,
    across: Direction | None = None, **params: Any,
) -> Joint:  # fmt: skip
    """Enter a joint with an axis. Raises ModelError, also where two bodies come without one."""
    axes = axes_given(f"{m.name}: joint '{name}'", axis, across)
    if axes is None and not isinstance(first, Marker):
        raise ModelError(f"{m.name}: joint '{name}' needs an axis: axis=(x, y, z), a direction of the world")
    return enter(m, kind, name, *markers_given(m, name, first, second, at, axes), **params)


def enter(
    m: Model, kind: JointKind, name: str, i: Marker, j: Marker, law: Law | None = None, coupled: Sequence[Joint] = (),
    **params: Any,
) -> Joint:  # fmt: skip
    """Enter a joint, or a driver with its law. Raises ModelError."""
    m.refuse_name(name, "driver" if kind.driven else "joint")
    motion = None
    if kind.driven:
        if not (isinstance(law, Motion) or callable(law)):
            raise ModelError(
                f"{m.name}: driver '{name}' needs a motion law, got {shown(law)}; "
                "say constant_rate(...), harmonic(...), or a function of time"
            )
        motion = law if isinstance(law, Motion) else Function(law)
    joint = Joint(kind, name, i, j, params, motion, tuple(coupled))
    (m.drivers if kind.driven else m.joints)[name] = joint
    return joint


def ends_given(
    m: Model, what: str, first: Fixing, second: Fixing, start: Place | None, end: Place | None
) -> tuple[Marker, Marker]:
    """Return markers at both ends, given or from places of the world (m). Raises ModelError."""
    markers = []
    for body, place, name in ((first, start, "start"), (second, end, "end")):
        if isinstance(body, Marker):
            if place is not None:
                raise ModelError(f"{what} has a marker and {name}=; a marker has a place, so leave {name} out")
            markers.append(own_marker(m, what, body))
        elif place is None:
            raise ModelError(f"{what} needs {name}=(x, y, z), a place of the world in the design pose (m)")
        else:
            markers.append(own_body(m, body, what).world_marker(np.array(place, float), np.eye(3)))
    refuse_same(what, *markers)
    return markers[0], markers[1]


def round_ends(
    m: Model, what: str, surface: Fixing, body: Fixing, at: Place | None, normal: Direction | None,
    centre: Place | None, axis: Direction | None, is_disc: bool,
) -> tuple[Marker, Marker]:  # fmt: skip
    """Return markers of the surface and of the round body. Raises ModelError."""
    if isinstance(surface, Marker):
        i = own_marker(m, what, surface)
    elif at is None or normal is None:
        raise ModelError(f"{what} needs at= and normal= of its surface, a place and a direction of the world")
    else:
        axes = axes_given(what, normal)
        i = own_body(m, surface, what).world_marker(np.array(at, float), np.eye(3) if axes is None else axes)
    if isinstance(body, Marker):
        j = own_marker(m, what, body)
    elif centre is None or (is_disc and axis is None):
        raise ModelError(f"{what} needs centre={', axis=' if is_disc else ''} of the round body in the world")
    else:
        middle = np.array(place_given(f"{what}: centre", centre))
        j = own_body(m, body, what).world_marker(middle, np.eye(3) if axis is None else frame(np.array(axis, float)))
    refuse_same(what, i, j)
    return i, j


def design_distance(i: Marker, j: Marker) -> float:
    """Return how far two markers are apart in the design pose (m)."""
    return float(np.linalg.norm(j.world_place - i.world_place))


def own_marker(m: Model, what: str, marker: Marker) -> Marker:
    """Return a marker on a body of this mechanism. Raises ModelError."""
    own_body(m, marker.body, what)
    return marker


def own_joint(m: Model, joint: Joint | str, what: str) -> Joint:
    """Return a joint of this mechanism, given as joint or name. Raises ModelError."""
    name = joint.name if isinstance(joint, Joint) else joint
    if not isinstance(name, str):
        raise ModelError(f"{what} needs a joint, got {shown(joint)}")
    if name not in m.joints:
        raise ModelError(f"{what}: {no_such('joint', name, m.joints)}")
    if isinstance(joint, Joint) and m.joints[name] is not joint:
        raise ModelError(f"{what} uses joint '{name}' of another mechanism; take one of this one")
    return m.joints[name]


def turning_joint(m: Model, joint: Joint | str, what: str) -> Joint:
    """Return a joint that turns about an axis. Raises ModelError."""
    known = own_joint(m, joint, what)
    if not known.kind.turns:
        raise ModelError(f"{what}: joint '{known.name}' is {known.kind.name} and has no turn; name one that turns")
    return known


def sliding_joint(m: Model, joint: Joint | str, what: str) -> Joint:
    """Return a joint that slides along an axis. Raises ModelError."""
    known = own_joint(m, joint, what)
    if not known.kind.slides:
        raise ModelError(f"{what}: joint '{known.name}' is {known.kind.name} and has no slide; name one that slides")
    return known


def refuse_same(what: str, i: Marker, j: Marker) -> None:
    """Raise ModelError where both markers are on one body."""
    if i.body is j.body:
        raise ModelError(f"{what} connects '{i.body.name}' with itself; give two bodies")


def add_force(
    m: Model, kind: ForceKind, name: str, i: Marker, j: Marker, params: Mapping[str, Any],
    laws: Mapping[str, Motion] | None = None, joint: Joint | None = None,
) -> Force:  # fmt: skip
    """Enter a force. Raises ModelError."""
    m.refuse_name(name, "force")
    force = m.forces[name] = Force(kind, name, i, j, params, laws or {}, joint)
    return force


def amount_given(what: str, amount: float | Law) -> tuple[dict[str, float], dict[str, Motion]]:
    """Return a number as a param, or a law of time: (params, laws). Raises ModelError."""
    if isinstance(amount, Motion):
        return {}, {"amount": amount}
    if callable(amount):
        return {}, {"amount": Function(amount)}
    return {"amount": finite_number(f"{what}: amount", amount)}, {}


def not_negative(what: str, **values: float) -> None:
    """Raise ModelError for a negative number among ``values``."""
    for name, value in values.items():
        if value < 0.0:
            raise ModelError(f"{what}: {name} is {value:g}; it cannot be negative")
