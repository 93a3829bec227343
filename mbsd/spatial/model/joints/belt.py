"""Belt or chain: two wheels on one carrier turn at one speed of the belt.

    Phi = r_1 / r_2 turn_1 - turn_2        1 row; the sign is plus where the belt is ``crossed``

The reaction on body j, the second wheel, is the moment of the belt about its axis.
"""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.base.arguments import number_pair
from mbsd.base.errors import ModelError
from mbsd.spatial.model.couplings import common_carrier, moved_marker, turn_of, turning_pair
from mbsd.spatial.model.entries import enter
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import Row


def _rows(joint: Joint) -> list[Row]:
    first, second = joint.coupled
    carrier = common_carrier(joint.name, joint.coupled)
    r_1, r_2 = joint.params["radii"]
    ratio = r_1 / r_2 * (1.0 if joint.params["crossed"] else -1.0)
    return [Row((turn_of(first, carrier, ratio), turn_of(second, carrier, 1.0)), "rad")]


def _example(m: Model, i: object, j: object) -> None:
    m.revolute("bearing 1", m.ground, i, at=(0.1, 0.2, 0.3), axis=(1, 2, -1))
    m.revolute("bearing 2", m.ground, j, at=(0.4, 0.2, 0.3), axis=(1, 2, -1))
    m.belt("example", "bearing 1", "bearing 2", radii=(0.05, 0.08))


BELT = register_joint(JointKind("belt", _rows, example=_example))


@BELT.adds
def belt(
    m: Model, name: str, first: Joint | str, second: Joint | str, radii: Sequence[float], crossed: bool = False
) -> Joint:
    """Couple the turns of two joints of one carrier by a belt over wheels of ``radii`` (m)."""
    what = f"{m.name}: joint '{name}'"
    a, b, carrier = turning_pair(m, what, first, second)
    both = number_pair(f"{what}: radii (m)", radii)
    if min(both) <= 0.0:
        raise ModelError(f"{what} has radii {both[0]:g} and {both[1]:g} m; they must be positive")
    i, j = moved_marker(a, carrier), moved_marker(b, carrier)
    return enter(m, BELT, name, i, j, coupled=(a, b), radii=both, crossed=crossed)
