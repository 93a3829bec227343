"""Contacts, which push but never pull: surfaces, discs, stops, ropes and freewheels.

Contact of a point or disc with a straight line: ground, a wall, an incline, a body's face.

    g = y - r            constraint `linear`; y: of marker j across the x axis of marker i, free side positive
    s = x + r a          constraint `linear`; way along the line of the touching point of the disc

N pushes marker j to the positive side. The line has no ends.

Contact of two discs around two markers, beside each other or one inside the other.

g = l - (r_i + r_j)     beside;    g = (r_i - r_j) - l     disc j inside ring i;     constraint `radial`
s = rolling way         constraint `gear` of radii r_i and r_j; see mbsd/equations/relative/gear.py

Contact of a point or disc with a terrain: a smooth curve through points, solid on its right.

    g = n . (p_j - c(u)) - r        constraint `curve`; c(u): the curve's point nearest to p_j
    s = arc + r (a - beta)          constraint `curve_rolling`; arc length and tangent angle beta at c(u)

N pushes marker j to the left of the curve. Beyond its ends an open curve goes on straight. A disc touches where the
curve is nearest to its centre, at one point; a disc that is too large for a bend of the curve raises an error.

Stops: ends of the travel of an angle or coordinate between two markers, as of a slider's guide.

    g = side (a - at)    constraint `turn`:   a, angle of marker j against marker i (rad, counted over whole turns)
    g = side (x - at)    constraint `linear`: x, of marker j along the x axis of marker i (m)

side = 1: the lower end; side = -1: the upper end.

Rope between two points: it pulls while it is taut and carries nothing while it is slack.

g = length - l       constraint `radial`

One-way clutch (freewheel, ratchet without play): body j turns against body i one way only.

    g = side (a - a_locked)      constraint `turn`;   g' >= 0

Locked, it holds the angle at which it locked; it opens as soon as its torque would have to pull.
"""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.body import Body, Marker
from mbsd.model.entries import add_contact, frictions_given, stop_given
from mbsd.model.joint import ContactKind, Joint, register_contact
from mbsd.model.mechanism import Model, connections, new_name, not_negative, own_body, own_joint
from mbsd.model.plane_curves import check_crossing, check_curvature, checked_points, disc_numbers


def _line_numbers(params):
    radius = params["radius"]
    return (0.0, 1.0, 0.0, radius), (1.0, 0.0, radius, 0.0)


LINE = register_contact(
    ContactKind(
        "rigid_contact",
        ("linear", "linear"),
        example=lambda m, i, j: m.rigid_contact("example", i, j),
        numbers=_line_numbers,
        lengths=("radius",),
        touching="line",
    )
)


@LINE.adds
def rigid_contact(
    m: Model,
    name: str,
    line: Marker,
    point: Marker,
    radius: float = 0.0,
    restitution: float = 0.0,
    friction: float = 0.0,
    static_friction: float | None = None,
) -> Joint:
    """Keep a point, or a disc of ``radius`` (m) around it, on the positive side of ``line``'s x axis.

    ``friction`` is Coulomb's coefficient; ``static_friction``, the same if not given, holds what sticks.
    """
    params = not_negative(m, f"contact '{name}'", radius=radius) | frictions_given(m, name, friction, static_friction)
    return add_contact(m, LINE, name, line, point, restitution, params)


def _discs_numbers(params):
    first, second, inside = params["radius_i"], params["radius_j"], params["inside"]
    if inside:
        return (-1.0, first - second), (first, -second)
    return (1.0, first + second), (first, second)


DISCS = register_contact(
    ContactKind(
        "rigid_discs",
        ("radial", "gear"),
        example=lambda m, i, j: m.rigid_discs("example", i, j, 0.05, 0.04),
        numbers=_discs_numbers,
        lengths=("radius_i", "radius_j"),
        touching="discs",
    )
)


@DISCS.adds
def rigid_discs(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    radius_i: float,
    radius_j: float,
    inside: bool = False,
    restitution: float = 0.0,
    friction: float = 0.0,
    static_friction: float | None = None,
) -> Joint:
    """Keep discs of two radii (m) around two markers apart; ``inside``: j is inside the ring i."""
    params = not_negative(m, f"contact '{name}'", radius_i=radius_i, radius_j=radius_j) | {"inside": bool(inside)}
    params |= frictions_given(m, name, friction, static_friction)
    reach = radius_i - radius_j if inside else radius_i + radius_j
    if reach <= 0:
        raise ModelError(
            f"{m.name}: contact '{name}': radii {radius_i:g} m and {radius_j:g} m leave no distance of the "
            "centres; " + ("the ring i must be larger than the disc j" if inside else "one must be positive")
        )
    return add_contact(m, DISCS, name, i, j, restitution, params)


TERRAIN = register_contact(
    ContactKind(
        "rigid_terrain",
        ("curve", "curve_rolling"),
        example=lambda m, i, j: m.rigid_terrain(
            "example", i, j, [(-6, -3), (-4, -2.5), (-2, -2), (0, -2.3), (2, -2.5), (4, -1.8), (6, -1.9)], radius=0.2
        ),
        numbers=lambda params: disc_numbers(params, follows=False),
        lengths=("radius", "points"),
        touching="curve",
    )
)


@TERRAIN.adds
def rigid_terrain(
    m: Model,
    name: str,
    terrain: Marker,
    point: Marker,
    points: Sequence[Sequence[float]],
    radius: float = 0.0,
    closed: bool = False,
    restitution: float = 0.0,
    friction: float = 0.0,
    static_friction: float | None = None,
) -> Joint:
    """A point, or a disc of ``radius`` (m) around it, stays on the left of a smooth curve.

    It goes through ``points`` (k, 2) in the axes of marker ``terrain`` (m), for a ground from left to right; beyond
    its ends an open curve goes on straight. A ``closed`` one is solid within where its points go clockwise, so that
    what touches it stays outside, and solid outside where they go counter-clockwise.
    """
    what = f"{m.name}: contact '{name}'"
    params = not_negative(m, f"contact '{name}'", radius=radius) | frictions_given(m, name, friction, static_friction)
    plain = checked_points(what, points, closed)
    check_crossing(what, plain, closed)
    check_curvature(what, plain, closed, params["radius"])
    params |= {"points": plain, "closed": bool(closed)}
    return add_contact(m, TERRAIN, name, terrain, point, restitution, params)


def _side(params):
    return -1.0 if params["upper"] else 1.0


ANGLE_STOP = register_contact(
    ContactKind(
        "angle_stop",
        ("turn",),
        example=lambda m, i, j: m.angle_stop("example", i, j, -3.0),
        numbers=lambda params: ((0.0, 0.0, _side(params), _side(params) * params["at"]),),
    )
)
COORDINATE_STOP = register_contact(
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


ROPE = register_contact(
    ContactKind(
        "rope",
        ("radial",),
        look="cord",
        example=lambda m, i, j: m.rope("example", i, j, 5.0),
        numbers=lambda params: ((-1.0, params["length"]),),
        lengths=("length",),
    )
)


@ROPE.adds
def rope(m: Model, name: str, i: Marker, j: Marker, length: float, restitution: float = 0.0) -> Joint:
    """The points of two markers stay no more than ``length`` (m) apart."""
    if length <= 0:
        raise ModelError(f"{m.name}: rope '{name}' has length {length:g} m; it must be positive")
    return add_contact(m, ROPE, name, i, j, restitution, {"length": length})


ONE_WAY = register_contact(
    ContactKind(
        "one_way",
        ("turn",),
        example=lambda m, i, j: m.one_way("example", i.body, j.body),
        numbers=lambda params: ((0.0, 0.0, -1.0 if params["clockwise"] else 1.0, 0.0),),
        always_closed=True,
    )
)


@ONE_WAY.adds
def one_way(m: Model, name: str, first: Body | str, second: Body | str, clockwise: bool = False) -> Joint:
    """A one-way clutch: ``second`` turns against ``first`` only counter-clockwise, or only clockwise."""
    i, j = (own_body(m, body, f"contact '{name}'").origin for body in (first, second))
    return add_contact(m, ONE_WAY, name, i, j, None, {"clockwise": bool(clockwise)})
