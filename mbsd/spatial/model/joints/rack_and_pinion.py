"""Rack and pinion: a joint that turns and one that slides, on one carrier.

    Phi = slide - radius turn        1 row

A negative radius turns the pinion the other way. The reaction on body j, the rack, is the force along its way.
"""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.spatial.model.couplings import common_carrier, moved_marker, slide_of, turn_of
from mbsd.spatial.model.entries import enter, sliding_joint, turning_joint
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import Row


def _rows(joint: Joint) -> list[Row]:
    pinion, rack = joint.coupled
    carrier = common_carrier(joint.name, joint.coupled)
    return [Row((slide_of(rack, carrier, 1.0), turn_of(pinion, carrier, -joint.params["radius"])), "m")]


def _example(m: Model, i: object, j: object) -> None:
    m.revolute("bearing", m.ground, i, at=(0.1, 0.2, 0.3), axis=(1, 2, -1))
    m.prismatic("rail", m.ground, j, at=(0.4, 0.2, 0.3), axis=(1, 0, 1))
    m.rack_and_pinion("example", "bearing", "rail", radius=0.05)


RACK_AND_PINION = register_joint(JointKind("rack_and_pinion", _rows, example=_example))


@RACK_AND_PINION.adds
def rack_and_pinion(m: Model, name: str, pinion: Joint | str, rack: Joint | str, radius: float) -> Joint:
    """Couple the turn of joint ``pinion`` and the slide of joint ``rack`` by the pinion's ``radius`` (m)."""
    what = f"{m.name}: joint '{name}'"
    if radius == 0.0:
        raise ModelError(f"{what} has radius 0 m; give the pitch radius of the pinion")
    a, b = turning_joint(m, pinion, what), sliding_joint(m, rack, what)
    carrier = common_carrier(what, (a, b))
    i, j = moved_marker(a, carrier), moved_marker(b, carrier)
    return enter(m, RACK_AND_PINION, name, i, j, coupled=(a, b), radius=radius)
