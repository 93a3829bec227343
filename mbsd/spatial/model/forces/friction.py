"""Friction of a joint from its reaction: Coulomb with Stribeck's rise at low speed, and viscous; the smooth law.

    mu(s) = mu_k + (mu_s - mu_k) exp(-(s / s_S)^2)                  s: sliding speed
    hinge   torque = -mu(s) tanh(s / s_0) (N + N_0) r - c turn',    s = r turn'
    slider  force = -mu(s) tanh(s / s_0) (N + N_0) - c slide',      s = slide'
    N = max(|R|, 2 |M| / L)        R, M: reaction at the joint's place;  L: length over which it is guided, 0: |R|

Below s_0 joints creep instead of sticking; a joint that sticks by events is planar only. The reaction comes from the
multipliers, found together with the friction (equations/friction.py).

Sources: Armstrong-Helouvry, Dupont, Canudas de Wit 1994, Automatica 30 (Stribeck); Haug 1989, ch. 8.
"""

from __future__ import annotations

from mbsd.base.arguments import positive_number
from mbsd.base.errors import ModelError
from mbsd.spatial.model.entries import add_force, not_negative, own_joint
from mbsd.spatial.model.force import Force, ForceKind, Push, register_force
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import along, turn

NUMBERS = ("coefficient", "static", "stribeck", "viscous", "slip_speed", "preload", "lever", "length")


def _example(m: Model, i: object, j: object) -> None:
    m.revolute("bearing", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1))
    m.friction(
        "example", "bearing", 0.3, radius=0.05, static=0.4, viscous=0.02, preload=2.0, length=0.2, slip_speed=0.1
    )


FRICTION = register_force(
    ForceKind(
        "friction",
        lambda f: [Push(turn(f.i, f.j) if f.joint is not None and f.joint.kind.turns else along(f.i, "z", f.j))],
        friction_of=lambda f: [f.params[name] for name in NUMBERS],
        example=_example,
    )
)


@FRICTION.adds
def friction(
    m: Model, name: str, joint: Joint | str, coefficient: float, static: float | None = None, stribeck: float = 0.01,
    viscous: float = 0.0, radius: float = 0.0, length: float = 0.0, preload: float = 0.0, slip_speed: float = 1e-3,
) -> Force:  # fmt: skip
    """Friction of a revolute or prismatic joint from its actual reaction, by the smooth law.

    ``coefficient`` while sliding and ``static`` (the same by default) near rest, between them the speed ``stribeck``
    (m/s); ``viscous`` N s/m or N m s; ``radius`` of a hinge (m); ``length`` over which it is guided (m), 0 where
    moments press nothing; ``preload`` (N) adds to the normal force; below ``slip_speed`` (m/s) the joint creeps.
    """
    what = f"{m.name}: force '{name}'"
    known = own_joint(m, joint, what)
    if not known.kind.has_friction:
        raise ModelError(f"{what}: '{known.name}' is {known.kind.name}; friction needs a revolute or prismatic joint")
    static = coefficient if static is None else static
    not_negative(
        what, coefficient=coefficient, static=static, viscous=viscous, radius=radius, length=length, preload=preload
    )
    if (radius > 0.0) != known.kind.turns:
        raise ModelError(f"{what}: a revolute joint needs the radius of its pin (m), and no other has one")
    params = {
        "coefficient": coefficient, "static": static, "stribeck": positive_number(f"{what}: stribeck", stribeck, "m/s"),
        "viscous": viscous, "slip_speed": positive_number(f"{what}: slip_speed", slip_speed, "m/s"),
        "preload": preload, "lever": radius if known.kind.turns else 1.0, "length": length,
    }  # fmt: skip
    return add_force(m, FRICTION, name, known.i, known.j, params, joint=known)
