"""Ratios: a linear relation between the coordinates of two joints, without teeth, belts or radii.

    q_2 = ratio q_1 + offset        q: turn of a revolute joint (rad), or travel of a prismatic joint (m)

It is made of rows between two bodies each, as gears, belts and racks are. B is a body that both joints have:

    turns     theta_2 - theta_B = k (theta_1 - theta_B) + c     constraint `turns`, 1 row; the equation of gears
    travel    x + k a = c                                       constraint `rack` (linear.py), 1 row

In the second, x is how far the centre of what turns lies along the x axis of what slides, and a its angle against it.
The carrier B takes the difference of both torques as a couple in the pins. Two joints about one point, two that slide,
and two without a common body are connected over bodies without mass, which have no parts and are not drawn:

    idler          turns on B beside both joints, as much as joint 1 turns, or a travel unrolls
    differential   2 theta_C = theta_u + theta_v on a carrier C: twice, it makes two turns equal on different bodies
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from mbsd.base.arguments import number_pair
from mbsd.base.errors import ModelError
from mbsd.model.body import HIDDEN, Body, Marker
from mbsd.model.entries import join
from mbsd.model.joint import Joint, JointKind, register_joint
from mbsd.model.joints.pairs import angle_lock, revolute
from mbsd.model.mechanism import Model, connections, new_name, number_given, own_joint

SAME = 1e-9
"""Part of the larger coordinate within which two places are one, and of a ratio within which two are equal."""


def _turns_problem(params: Mapping[str, Any], x: float, y: float) -> str | None:
    if x != 0.0 or y != 0.0:
        return None
    return "both bodies turn about one point, and nothing tells them from their carrier; write m.ratio(...)"


TURN_RATIO = register_joint(
    JointKind(
        "turn_ratio",
        ("turns",),
        example=lambda m, i, j: m.turn_ratio("example", i, j, ratio=-2.5),
        numbers=lambda params: [(params["ratio"], -1.0)],
        problem=_turns_problem,
        touching="place",
    )
)


@TURN_RATIO.adds
def turn_ratio(
    m: Model, name: str, i: Marker, j: Marker, ratio: float, together: Sequence[float] | None = None
) -> Joint:
    """Make body j turn ``ratio`` times as much as body i, against the body that carries both by pins.

    ``together``: angles of both bodies against that one (rad) that belong together; by default those at the start. See
    :func:`ratio`, which finds the markers.
    """
    given: dict[str, Any] = {"ratio": _not_zero(m, name, ratio)}
    if together is not None:
        given["together"] = number_pair(f"{m.name}: joint '{name}': together (rad)", together)
    return join(m, TURN_RATIO, name, i, j, None, **given)


TRAVEL_RATIO = register_joint(
    JointKind(
        "travel_ratio",
        ("rack",),
        example=lambda m, i, j: m.travel_ratio("example", i, j, travel=0.3),
        numbers=lambda params: [(1.0, 0.0, params["travel"], 0.0)],
        touching="place",
    )
)


@TRAVEL_RATIO.adds
def travel_ratio(
    m: Model, name: str, slider: Marker, wheel: Marker, travel: float, total: float | None = None
) -> Joint:
    """Make ``slider`` move by ``travel`` (m/rad) along its x axis for each radian that ``wheel`` turns.

    ``total``: x + travel a (m), of the place x of the wheel's marker along that axis and its angle a against it; by
    default what it is at the start. See :func:`ratio`, which finds the markers.
    """
    given = {"travel": _not_zero(m, name, travel)}
    if total is not None:
        given["total"] = number_given(m, f"joint '{name}': total", total)
    return join(m, TRAVEL_RATIO, name, slider, wheel, None, **given)


def _not_zero(m: Model, name: str, value: float) -> float:
    number = number_given(m, f"joint '{name}': ratio", value)
    if number == 0.0:
        raise ModelError(f"{m.name}: joint '{name}' has the ratio 0, which locks the second joint; write m.weld(...)")
    return number


class Side(NamedTuple):
    """One of two joints, as a body moves on a carrier."""

    mover: Marker
    """The marker on what moves."""
    carrier: Marker
    sign: float
    """1 where the mover is the joint's second body, else -1."""
    slides: bool

    @property
    def bodies(self) -> tuple[Body, Body]:
        """Return the mover and the carrier."""
        return self.mover.body, self.carrier.body

    @property
    def swapped(self) -> Side:
        """Return the same joint with the bodies in each other's role."""
        return Side(self.carrier, self.mover, -self.sign, self.slides)


def ratio(
    m: Model, name: str, first: Joint | str, second: Joint | str, ratio: float, offset: float | None = None
) -> Joint:
    """Make the coordinate of the ``second`` joint ``ratio`` times that of the first, plus an ``offset``.

    The coordinate of a revolute joint is the angle of its marker j against marker i (rad), that of a prismatic joint
    the travel of j along the x axis of i (m); so ``ratio`` is a number, or in m/rad or rad/m. By default the offset is
    what it is at the start. Returns the joint of this name; others, named after it, may connect bodies without mass.
    Raises ModelError for joints of other kinds, and where gears already hold another ratio.

        m.ratio("minutes", hour_pin, minute_pin, 12)
    """
    what = f"joint '{name}'"
    joints = own_joint(m, first, what), own_joint(m, second, what)
    new_name(m, name, "joint", *connections(m))
    if joints[0] is joints[1]:
        raise ModelError(f"{m.name}: {what} is between '{joints[0].name}' and itself; give two joints")
    sides = [_side(m, name, joint) for joint in joints]
    factor = _not_zero(m, name, ratio)
    shift = None if offset is None else number_given(m, f"{what}: offset", offset)
    shared = _on_one_carrier(sides[0], sides[1])
    bodies, before = dict(m.bodies), dict(m.joints)
    try:
        if shared is None:
            row = _differential(m, name, sides[0], sides[1], factor, shift)
        else:
            row = _on_carrier(m, name, *shared, factor, shift)
        refuse_contradictions(m)
    except ModelError:
        for table, kept in ((m.bodies, bodies), (m.joints, before)):
            table.clear()
            table.update(kept)  # pyright: ignore[reportArgumentType, reportCallIssue]
        raise
    return row


def _side(m: Model, name: str, joint: Joint) -> Side:
    if joint.kind.pair not in ("pin", "guide"):
        raise ModelError(
            f"{m.name}: joint '{name}': '{joint.name}' is a {joint.kind.name}; a ratio needs joints with one "
            "coordinate: revolute, prismatic"
        )
    return Side(joint.j, joint.i, 1.0, joint.kind.pair == "guide")


def _on_one_carrier(first: Side, second: Side) -> tuple[Side, Side] | None:
    """Return both joints as motions on a body that they share; None if they share none."""
    for near in (first, first.swapped):
        for far in (second, second.swapped):
            if near.carrier.body is far.carrier.body and near.mover.body is not far.mover.body:
                return near, far
    return None


def _on_carrier(m: Model, name: str, first: Side, second: Side, factor: float, shift: float | None) -> Joint:
    """Connect two joints of one carrier, where needed over an idler. ``shift``: the offset, or None."""
    if first.slides and second.slides:
        radius = _reach(m)
        idler = _idler(m, f"{name} idler", second.carrier, radius)
        _travels(m, f"{name} 1", first, idler, radius, 0.0, shift is not None)
        return _travels(
            m, name, second, idler, second.sign * first.sign * factor * radius, shift or 0.0, shift is not None
        )
    if first.slides:
        travel = first.sign * second.sign / factor
        return _travels(m, name, first, second, travel, -(shift or 0.0) / factor, shift is not None)
    if second.slides:
        return _travels(m, name, second, first, first.sign * second.sign * factor, shift or 0.0, shift is not None)
    apart = math.dist((first.carrier.x, first.carrier.y), (second.carrier.x, second.carrier.y))
    if apart <= SAME * _reach(m):
        idler = _idler(m, f"{name} idler", first.carrier, _reach(m))
        _turns(m, f"{name} 1", first, idler, first.sign, None if shift is None else 0.0)
        first = idler
    return _turns(m, name, first, second, first.sign * second.sign * factor, shift)


def _turns(m: Model, name: str, first: Side, second: Side, factor: float, shift: float | None) -> Joint:
    together = None
    if shift is not None:
        angles = [side.carrier.angle - side.mover.angle for side in (first, second)]
        together = angles[0], angles[1] + second.sign * shift
    return turn_ratio(m, name, first.mover, second.mover, factor, together)


def _travels(m: Model, name: str, slide: Side, turn: Side, travel: float, start: float, absolute: bool) -> Joint:
    """Connect a slide and a turn on a carrier. ``start``: travel where the turn is 0 (m), if ``absolute``."""
    total = None
    if absolute:
        rail, pin = slide.carrier, turn.carrier
        along = math.cos(rail.angle) * (pin.x - rail.x) + math.sin(rail.angle) * (pin.y - rail.y)
        total = along - slide.sign * start + travel * (pin.angle - rail.angle)
    return travel_ratio(m, name, slide.mover, turn.mover, travel, total)


def _idler(m: Model, name: str, beside: Marker, distance: float) -> Side:
    """Add a body without mass that turns on the body of a marker, and return its joint."""
    centre = beside.body.at(beside.x + distance, beside.y)
    body = m.body(name, mass=0.0, looks=HIDDEN)
    revolute(m, f"{name} axle", centre, body.origin)
    return Side(body.origin, centre, 1.0, False)


def _reach(m: Model) -> float:
    """Return the largest coordinate of a marker of a joint (m), 1 if all are at origins."""
    places = [abs(x) for joint in m.joints.values() for end in (joint.i, joint.j) for x in (end.x, end.y)]
    return max(places, default=0.0) or 1.0


def _differential(m: Model, name: str, first: Side, second: Side, factor: float, shift: float | None) -> Joint:
    """Connect joints without a common body: an idler on the first carrier turns as one on the second."""
    reach = _reach(m)
    idler = _idler(m, f"{name} idler", first.carrier, reach)
    if second.slides:
        other = _idler(m, f"{name} pinion", second.carrier, reach)
        _travels(m, f"{name} 2", second, other, second.sign * reach, 0.0, shift is not None)
        scale, second = 1.0 / reach, other
    else:
        scale = 1.0
    moved = None if shift is None else scale * shift
    row = _on_carrier(m, name, first, idler, scale * factor, moved)
    if second.sign < 0.0:
        second = second.swapped
    arm = m.body(f"{name} arm", mass=0.0, looks=HIDDEN)
    revolute(m, f"{name} arm axle", idler.carrier, arm.origin)
    turned = second.carrier.angle - second.mover.angle
    halves = (idler.mover, second.carrier.body, 0.0), (idler.carrier, second.mover.body, turned)
    for k, (centre, copied, angle) in enumerate(halves, start=1):
        copy = m.body(f"{name} copy {k}", mass=0.0, looks=HIDDEN)
        revolute(m, f"{name} copy axle {k}", arm.at(reach, 0.0), copy.origin)
        angle_lock(m, f"{name} lock {k}", copied.origin, copy.origin)
        together = None if shift is None else (0.0, angle)
        turn_ratio(m, f"{name} half {k}", centre, copy.origin, -1.0, together)
    return row


_Coordinate = tuple[str, str, bool]
"""Names of the carrier and of what moves on it, and whether that slides."""


class _Link(NamedTuple):
    """A row that makes the coordinate of one end ``factor`` times that of the other."""

    name: str
    end: _Coordinate
    factor: float


def refuse_contradictions(m: Model) -> None:
    """Raise ModelError where ratios, gears and racks hold two ratios between the same coordinates."""
    if not any(joint.kind in (TURN_RATIO, TRAVEL_RATIO) for joint in m.joints.values()):
        return
    links: dict[_Coordinate, list[_Link]] = {}
    for joint in m.joints.values():
        for first, other, factor in _relations(m, joint):
            known = _known_ratio(links, first, other)
            if known is not None and abs(known[1] - factor) > SAME * abs(factor):
                _refuse(m, joint, first, other, factor, known)
            links.setdefault(first, []).append(_Link(joint.name, other, factor))
            links.setdefault(other, []).append(_Link(joint.name, first, 1.0 / factor))


def _refuse(
    m: Model, joint: Joint, first: _Coordinate, other: _Coordinate, factor: float, known: tuple[list[str], float]
) -> None:
    names, factor_known = known
    already = f"{' and '.join(repr(name) for name in names)} already {'make' if len(names) > 1 else 'makes'} it"
    raise ModelError(
        f"{m.name}: joint '{joint.name}' makes '{other[1]}' move {factor:.6g} times as much as '{first[1]}' on "
        f"'{first[0]}', but {already} {factor_known:.6g} times: together they lock both. Leave one out, or let the "
        "ratios agree"
    )


def _known_ratio(
    links: Mapping[_Coordinate, Sequence[_Link]], first: _Coordinate, other: _Coordinate
) -> tuple[list[str], float] | None:
    """Return the joints that connect two coordinates already, and their ratio; None if none do."""
    waiting: list[tuple[_Coordinate, list[str], float]] = [(first, [], 1.0)]
    seen = {first}
    while waiting:
        at, names, factor = waiting.pop(0)
        if at == other:
            return names, factor
        for link in links.get(at, ()):
            if link.end not in seen:
                seen.add(link.end)
                waiting.append((link.end, [*names, link.name], factor * link.factor))
    return None


def _relations(m: Model, joint: Joint) -> Iterator[tuple[_Coordinate, _Coordinate, float]]:
    """Yield the coordinates on a common carrier that a gear, belt, rack or ratio connects, and its ratio."""
    constraint = joint.kind.constraints[0]
    if constraint not in ("gear", "turns", "rack") or joint.kind.numbers is None:
        return
    numbers = joint.kind.numbers(joint.params)[0]
    if constraint != "rack":
        first, second = numbers
        for carrier in _carriers(m, joint.i, "pin") & _carriers(m, joint.j, "pin"):
            yield (carrier, joint.i.body.name, False), (carrier, joint.j.body.name, False), float(-first / second)
    else:
        # one sense for all markers of a slider, whichever way their x axes point along it
        sense = 1.0 if math.cos(joint.i.angle - 1e-3) > 0.0 else -1.0
        for carrier in _carriers(m, joint.i, "guide") & _carriers(m, joint.j, "pin"):
            yield (carrier, joint.j.body.name, False), (carrier, joint.i.body.name, True), sense * float(numbers[2])


def _carriers(m: Model, marker: Marker, pair: str) -> set[str]:
    """Return the bodies that carry a marker's body by a joint of this pair, a pin at the marker's place."""
    out = set()
    for joint in m.joints.values():
        for own, other in ((joint.i, joint.j), (joint.j, joint.i)):
            near = pair == "guide" or math.dist((own.x, own.y), (marker.x, marker.y)) <= SAME
            if joint.kind.pair == pair and own.body is marker.body and near:
                out.add(other.body.name)
    return out
