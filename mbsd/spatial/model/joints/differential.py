"""Differential: two outputs and a carrier that turn about joints of one housing.

    Phi = turn_left + ratio turn_right - (1 + ratio) turn_carrier        1 row

With ratio 1, that of bevel wheels, the carrier turns at the mean of both outputs. The reaction on body j, the right
output, is the moment about its axis.
"""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.spatial.model.couplings import common_carrier, moved_marker, turn_of
from mbsd.spatial.model.entries import enter, turning_joint
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import Row


def _rows(joint: Joint) -> list[Row]:
    housing = common_carrier(joint.name, joint.coupled)
    ratio = joint.params["ratio"]
    weights = 1.0, ratio, -1.0 - ratio
    turns = [turn_of(part, housing, weight) for part, weight in zip(joint.coupled, weights, strict=True)]
    return [Row(tuple(turns), "rad")]


def _example(m: Model, i: object, j: object) -> None:
    cage = m.body("cage", 1.0, inertia=(1.0, 1.0, 1.0))
    for name, body in (("left", i), ("right", j), ("middle", cage)):
        m.revolute(name, m.ground, body, at=(0.1, 0.2, 0.3), axis=(1, 2, -1))
    m.differential("example", "left", "right", "middle")


DIFFERENTIAL = register_joint(JointKind("differential", _rows, example=_example))


@DIFFERENTIAL.adds
def differential(
    m: Model, name: str, left: Joint | str, right: Joint | str, carrier: Joint | str, ratio: float = 1.0
) -> Joint:
    """Couple the turns of three joints of one housing; ``ratio`` is that of teeth, right over left."""
    what = f"{m.name}: joint '{name}'"
    if not ratio > 0.0:
        raise ModelError(f"{what} has ratio {ratio:g}; it must be positive, 1 for equal wheels")
    a, b, c = joints = tuple(turning_joint(m, joint, what) for joint in (left, right, carrier))
    if len({joint.name for joint in joints}) < 3:
        raise ModelError(f"{what} names a joint twice; give those of the left, the right and the carrier")
    housing = common_carrier(what, joints)
    i, j = moved_marker(a, housing), moved_marker(b, housing)
    return enter(m, DIFFERENTIAL, name, i, j, coupled=(a, b, c), ratio=ratio)
