"""Torsion spring with a damper about the axis of a joint.

T = stiffness (free - turn) - damping turn'        on the joint's second body
"""

from __future__ import annotations

from mbsd.spatial.model.entries import add_force, not_negative, turning_joint
from mbsd.spatial.model.force import Force, ForceKind, Push, register_force
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import turn


def _example(m: Model, i: object, j: object) -> None:
    m.revolute("bearing", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1))
    m.torsion_spring("example", "bearing", stiffness=3.0, damping=0.2, free=0.4)


TORSION_SPRING = register_force(
    ForceKind(
        "torsion_spring",
        lambda f: [Push(turn(f.i, f.j), f.params["stiffness"], f.params["free"], f.params["damping"])],
        example=_example,
    )
)


@TORSION_SPRING.adds
def torsion_spring(
    m: Model, name: str, joint: Joint | str, stiffness: float = 0.0, damping: float = 0.0, free: float = 0.0
) -> Force:
    """A spring (N m/rad) with a damper (N m s/rad) about a joint's axis; ``free``: its turn at rest."""
    what = f"{m.name}: force '{name}'"
    known = turning_joint(m, joint, what)
    not_negative(what, stiffness=stiffness, damping=damping)
    params = {"stiffness": stiffness, "damping": damping, "free": free}
    return add_force(m, TORSION_SPRING, name, known.i, known.j, params, joint=known)
