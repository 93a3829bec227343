"""Torque about the axis of a joint, a number or a law of time.

T = amount(t)        on the joint's second body; the first body gets the opposite
"""

from __future__ import annotations

from mbsd.model.laws import harmonic
from mbsd.spatial.model.entries import Law, add_force, amount_given, turning_joint
from mbsd.spatial.model.force import Force, ForceKind, Push, register_force
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import turn


def _example(m: Model, i: object, j: object) -> None:
    m.revolute("bearing", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1))
    m.torque("example", "bearing", harmonic(3.0, 2.0))


TORQUE = register_force(
    ForceKind(
        "torque",
        lambda f: [Push(turn(f.i, f.j), amount=f.params.get("amount", 0.0), law="amount" if f.laws else "")],
        example=_example,
    )
)


@TORQUE.adds
def torque(m: Model, name: str, joint: Joint | str, amount: float | Law) -> Force:
    """A torque (N m) about a joint's axis on its second body, a number or a law of time."""
    what = f"{m.name}: force '{name}'"
    known = turning_joint(m, joint, what)
    params, laws = amount_given(what, amount)
    return add_force(m, TORQUE, name, known.i, known.j, params, laws, known)
