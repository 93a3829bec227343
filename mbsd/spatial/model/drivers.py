"""Drivers in space: motion laws imposed on the turn or the slide of a joint, or on a distance.

Turn driver: imposes how far the second body of a joint turns against the first about the joint's axis, counted from the
design pose.

    Phi = turn - f(t)        1 row; nu = f', gamma = f'' + convective part

Effort: the torque it gives to the second body about the axis.

Slide driver: imposes how far the second body moves along the joint's axis.

    Phi = z_i . d - f(t)        1 row

Effort: the force it gives to the second body along the axis.

Distance driver (linear actuator): imposes the distance of two places.

    Phi = |d| - f(t)        1 row

Effort: the force it pushes with, positive when it pushes the places apart.
"""

from __future__ import annotations

from mbsd.model.laws import harmonic
from mbsd.spatial.model.body import Fixing, Place
from mbsd.spatial.model.entries import Law, ends_given, enter, sliding_joint, turning_joint
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import along, distance, turn


def _turned(m: Model, i: object, j: object) -> None:
    m.revolute("bearing", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1))
    m.drive_turn("example", "bearing", harmonic(0.3, 1.7, 0.2, 0.9))


def _slid(m: Model, i: object, j: object) -> None:
    m.prismatic("rail", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1))
    m.drive_slide("example", "rail", harmonic(0.3, 1.7, 0.2, 0.9))


DRIVE_TURN = register_joint(
    JointKind("drive_turn", lambda d: [turn(d.i, d.j)], example=_turned, driven=True, unit="rad")
)


@DRIVE_TURN.adds
def drive_turn(m: Model, name: str, joint: Joint | str, law: Law) -> Joint:
    """Impose the turn of a joint's second body against the first (rad), 0 in the design pose."""
    known = turning_joint(m, joint, f"{m.name}: driver '{name}'")
    return enter(m, DRIVE_TURN, name, known.i, known.j, law, (known,))


DRIVE_SLIDE = register_joint(
    JointKind("drive_slide", lambda d: [along(d.i, "z", d.j)], example=_slid, driven=True, unit="m")
)


@DRIVE_SLIDE.adds
def drive_slide(m: Model, name: str, joint: Joint | str, law: Law) -> Joint:
    """Impose the slide of a joint's second body along its axis (m), 0 in the design pose."""
    known = sliding_joint(m, joint, f"{m.name}: driver '{name}'")
    return enter(m, DRIVE_SLIDE, name, known.i, known.j, law, (known,))


DRIVE_DISTANCE = register_joint(
    JointKind(
        "drive_distance",
        lambda d: [distance(d.i, d.j)],
        example=lambda m, i, j: m.drive_distance(
            "example", i, j, harmonic(0.3, 1.7, 0.2, 0.9), start=(0.1, 0.2, 0.3), end=(-0.2, 0.5, 0.8)
        ),
        driven=True,
        unit="m",
    )
)


@DRIVE_DISTANCE.adds
def drive_distance(
    m: Model, name: str, first: Fixing, second: Fixing, law: Law, start: Place | None = None, end: Place | None = None
) -> Joint:
    """Impose the distance (m) of ``start`` on the first body and ``end`` on the second."""
    i, j = ends_given(m, f"{m.name}: driver '{name}'", first, second, start, end)
    return enter(m, DRIVE_DISTANCE, name, i, j, law)
