"""Rolling: a ball, a disc or a wheel rolls on a plane without slip and stays on it.

    Phi = height of the lowest point;  its velocity along x_i and y_i is zero        3 rows

The last two hold rates and no place (non-holonomic), so such a mechanism is simulated, not swept. The reaction on body
j is the force of the plane; its moment is about the centre. A disc that lies flat has no lowest point.
"""

from __future__ import annotations

from mbsd.base.arguments import not_negative_number
from mbsd.base.errors import ModelError
from mbsd.spatial.model.body import Direction, Fixing, Place
from mbsd.spatial.model.entries import enter, round_ends
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import roll

ROLLING = register_joint(
    JointKind(
        "rolling",
        lambda joint: [roll(joint.i, joint.j, joint.params["ring"], joint.params["radius"])],
        example=lambda m, i, j: m.rolling(
            "example", i, j, at=(0.1, 0.2, 0.3), normal=(0, 0, 1), centre=(0.2, 0.3, 0.6), axis=(0, 1, 0), ring=0.2,
            radius=0.1,
        ),
        holds_rates=True,
    )
)  # fmt: skip


@ROLLING.adds
def rolling(
    m: Model, name: str, plane: Fixing, wheel: Fixing, at: Place | None = None, normal: Direction | None = None,
    centre: Place | None = None, axis: Direction | None = None, radius: float = 0.0, ring: float = 0.0,
) -> Joint:  # fmt: skip
    """A wheel that rolls without slip on the plane through ``at`` (m) with this ``normal``, or a marker's.

    It is a ball of ``radius`` (m) about ``centre``, a disc of radius ``ring`` about ``axis``, or with both a ring with
    a round rim. It must touch the plane in the design pose; of a marker place and z axis are taken.
    """
    what = f"{m.name}: joint '{name}'"
    for word, number in (("ring", ring), ("radius", radius)):
        not_negative_number(f"{what}: {word}", number, "m")
    if not ring + radius > 0.0:
        raise ModelError(f"{what} needs radius= of a ball or ring= of a disc (m), above zero")
    i, j = round_ends(m, what, plane, wheel, at, normal, centre, axis, ring > 0.0)
    return enter(m, ROLLING, name, i, j, ring=ring, radius=radius)
