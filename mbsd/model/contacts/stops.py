"""Stops: ends of the travel of an angle or coordinate between two markers, as of a slider's guide.

    g = side (a - at)    constraint `turn`:   a, angle of marker j against marker i (rad, counted over whole turns)
    g = side (x - at)    constraint `linear`: x, of marker j along the x axis of marker i (m)

side = 1: the lower end; side = -1: the upper end.
"""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.adding.contacts import add_contact, stop_given
from mbsd.model.body import Marker
from mbsd.model.contact import ContactKind, register
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model, connections, new_name, own_joint


def _side(params):
    return -1.0 if params["upper"] else 1.0


ANGLE_STOP = register(
    ContactKind(
        "angle_stop",
        ("turn",),
        example=lambda m, i, j: m.angle_stop("example", i, j, -3.0),
        numbers=lambda params: ((0.0, 0.0, _side(params), _side(params) * params["at"]),),
    )
)
COORDINATE_STOP = register(
    ContactKind(
        "coordinate_stop",
        ("linear",),
        example=lambda m, i, j: m.coordinate_stop("example", i, j, -3.0),
        numbers=lambda params: ((_side(params), 0.0, 0.0, _side(params) * params["at"]),),
    )
)


@ANGLE_STOP.adds
def angle_stop(
    m: Model, name: str, i: Marker, j: Marker, at: float, upper: bool = False, restitution: float = 0.0
) -> Joint:
    """The angle of marker j against marker i (rad, counted over turns) does not fall below ``at``.

    ``upper``: it does not rise above.
    """
    return add_contact(m, ANGLE_STOP, name, i, j, restitution, stop_given(m, name, at, upper))


@COORDINATE_STOP.adds
def coordinate_stop(
    m: Model, name: str, i: Marker, j: Marker, at: float, upper: bool = False, restitution: float = 0.0
) -> Joint:
    """Marker j does not come below ``at`` (m) along the x axis of marker i; ``upper``: not above."""
    return add_contact(m, COORDINATE_STOP, name, i, j, restitution, stop_given(m, name, at, upper))


def stop(
    m: Model,
    name: str,
    joint: Joint | str,
    lower: float | None = None,
    upper: float | None = None,
    restitution: float = 0.0,
) -> tuple[Joint, ...]:
    """Ends of the way of a revolute (rad) or prismatic joint (m), named ``name lower`` and ``name upper``."""
    if lower is None and upper is None:
        raise ModelError(f"{m.name}: stop '{name}' has no end; give lower=, upper= or both")
    if lower is not None and upper is not None and not lower < upper:
        raise ModelError(f"{m.name}: stop '{name}': lower is {lower:g}, upper {upper:g}; lower must be less")
    joint = own_joint(m, joint, f"stop '{name}'")
    if joint.kind.pair not in ("pin", "guide"):
        raise ModelError(f"{m.name}: stop '{name}' needs a revolute or prismatic joint, got {shown(joint)}")
    add = angle_stop if joint.kind.pair == "pin" else coordinate_stop
    ends = [("lower", lower, False), ("upper", upper, True)]
    given = [(f"{name} {end}", at, is_upper) for end, at, is_upper in ends if at is not None]
    for end_name, _, _ in given:
        new_name(m, end_name, "contact", *connections(m))
    return tuple(add(m, end_name, joint.i, joint.j, at, is_upper, restitution) for end_name, at, is_upper in given)
