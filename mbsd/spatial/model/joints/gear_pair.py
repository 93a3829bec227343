"""Gear pair of any axes, spur, bevel, worm, helical: two joints turn in the ratio of teeth.

    Phi = z_1 / z_2 turn_1 + turn_2        1 row; the sign is minus with ``internal``

Both turns are against the carrier. Axes of spur gears that point alike, and of bevel gears that both point away from
their apex, turn against each other: the default. The reaction on body j, the second gear, is the moment about its axis;
the first gear and the carrier take the rest.
"""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.spatial.model.couplings import common_carrier, moved_marker, teeth_given, turn_of, turning_pair
from mbsd.spatial.model.entries import enter
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import Row


def _rows(joint: Joint) -> list[Row]:
    first, second = joint.coupled
    carrier = common_carrier(joint.name, joint.coupled)
    z_1, z_2 = joint.params["teeth"]
    ratio = z_1 / z_2 * (-1.0 if joint.params["internal"] else 1.0)
    return [Row((turn_of(first, carrier, ratio), turn_of(second, carrier, 1.0)), "rad")]


def _example(m: Model, i: object, j: object) -> None:
    m.revolute("bearing 1", m.ground, i, at=(0.1, 0.2, 0.3), axis=(1, 2, -1))
    m.revolute("bearing 2", j, m.ground, at=(0.4, 0.2, 0.3), axis=(1, 0, 1))
    m.gear_pair("example", "bearing 1", "bearing 2", teeth=(17, 31))


GEAR_PAIR = register_joint(JointKind("gear_pair", _rows, example=_example))


@GEAR_PAIR.adds
def gear_pair(
    m: Model, name: str, first: Joint | str, second: Joint | str, teeth: Sequence[int], internal: bool = False
) -> Joint:
    """Couple the turns of two joints by ``teeth`` (z_1, z_2); ``internal``: both turn the same way."""
    what = f"{m.name}: joint '{name}'"
    counts = teeth_given(what, teeth)
    a, b, carrier = turning_pair(m, what, first, second)
    i, j = moved_marker(a, carrier), moved_marker(b, carrier)
    return enter(m, GEAR_PAIR, name, i, j, coupled=(a, b), teeth=counts, internal=internal)
