"""Turns and slides of joints on one carrier, of which gears, racks, belts and differentials are sums.

Joint and carrier are written as the user likes, so a turn counts the other way where the carrier is the joint's second
body.
"""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.spatial.model.body import Body, Marker
from mbsd.spatial.model.entries import turning_joint
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import Term


def common_carrier(what: str, joints: tuple[Joint, ...]) -> Body:
    """Return the body that all joints have in common. Raises ModelError."""
    shared = [
        body for body in (joints[0].i.body, joints[0].j.body) if all(body in (j.i.body, j.j.body) for j in joints)
    ]
    if not shared:
        pairs = ", ".join(f"'{j.name}' joins {' and '.join(j.bodies)}" for j in joints)
        raise ModelError(f"{what}: its joints share no body that carries them: {pairs}. Name joints on one carrier")
    return shared[0]


def moved_marker(joint: Joint, carrier: Body) -> Marker:
    """Return the marker of a joint that is not on its carrier."""
    return joint.j if joint.i.body is carrier else joint.i


def turn_of(joint: Joint, carrier: Body, weight: float) -> Term:
    """Return the turn of a joint's body against the carrier, about the joint's axis, ``weight`` times."""
    return Term("turn", joint.i, joint.j, weight=weight if joint.i.body is carrier else -weight)


def slide_of(joint: Joint, carrier: Body, weight: float) -> Term:
    """Return the slide of a joint's body against the carrier, along the joint's axis, ``weight`` times."""
    return Term("along", joint.i, joint.j, "z", weight=weight if joint.i.body is carrier else -weight)


def turning_pair(m: Model, what: str, first: Joint | str, second: Joint | str) -> tuple[Joint, Joint, Body]:
    """Return two different joints that turn, and the body that carries both. Raises ModelError."""
    a, b = turning_joint(m, first, what), turning_joint(m, second, what)
    if a is b:
        raise ModelError(f"{what} couples joint '{a.name}' with itself; name two joints")
    return a, b, common_carrier(what, (a, b))


def teeth_given(what: str, value: object) -> tuple[int, int]:
    """Return two whole numbers of teeth. Raises ModelError."""
    try:
        counts = tuple(value)  # pyright: ignore[reportArgumentType]
    except TypeError:
        counts = ()
    if len(counts) != 2 or any(isinstance(z, bool) or int(z) != z or z < 1 for z in counts):
        raise ModelError(f"{what} has teeth {shown(value)}; give two whole numbers above zero (z_1, z_2)")
    return int(counts[0]), int(counts[1])
