"""Friction of a joint from its reaction: Coulomb with Stribeck's rise at low speed, and viscous.

    mu(s) = mu_k + (mu_s - mu_k) exp(-(s / s_S)^2)           s: sliding speed
    F     = -mu(s) tanh(s / s_0) (N + N_0) - c s             N_0: preload, as of a spring that presses
    pin:    s = r omega,  torque = -mu(s) tanh(s / s_0) (N + N_0) r - c omega;    N = |reaction|, r its radius
    guide:  N = max(|R|, 2 |M| / L)      R across the guide, M its torque at marker j, L how long the slider is guided:
                                         two edges L apart carry R and M, and N is the sum of what they carry
    slot:   N = |reaction|

The smooth form: below s_0 joints creep instead of sticking. The form by events has sign(s) in place of tanh: a
simulation finds the time when s = 0, where the joint sticks as long as |F| <= mu_s (N + N_0), of a pin times r, holds
it with a row of J, and finds the time when it slides (dynamics/switches.py, events/sticking/). A known
motion, as in a sweep, determines no friction at rest: it is counted as zero in both forms.

The reactions come from the multipliers, found together with the friction (joint_friction.py). Redundant joints share
loads as the program happens to find them, and so does their friction. Sources: Armstrong-Helouvry, Dupont, Canudas de
Wit 1994, Automatica 30 (Stribeck); Haug 1989, ch. 8; Pfeiffer, Glocker 1996, ch. 5 (events).
"""

from __future__ import annotations

from typing import Any

from mbsd.base.errors import ModelError
from mbsd.model.entries import above_zero, add_force, amounts_given
from mbsd.model.force import Force, ForceKind, register_force
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model, own_joint


def _example(m: Any, i: Any, j: Any) -> None:
    m.revolute("pin", i, j)
    m.friction("example", "pin", 0.3, static=0.4, viscous=0.05, radius=0.2, slip_speed=0.1, stribeck=0.3)


FRICTION = register_force(ForceKind("friction", example=_example, of_reactions=True))


@FRICTION.adds
def friction(
    m: Model,
    name: str,
    joint: Joint | str,
    coefficient: float,
    static: float | None = None,
    stribeck: float = 0.01,
    viscous: float = 0.0,
    radius: float = 0.0,
    length: float = 0.0,
    preload: float = 0.0,
    slip_speed: float | None = None,
    sticks: bool = False,
) -> Force:
    """Friction of a revolute, prismatic or pin-in-slot joint from its actual reaction.

    ``coefficient`` while sliding and ``static`` (the same by default) near rest, between them the speed
    ``stribeck`` (m/s); ``viscous`` N s/m or N m s; ``radius`` of a pin (m); ``length`` over which a slider is
    guided (m), 0 where tilting presses nothing; ``preload`` (N) is added to the normal force; ``slip_speed``
    (m/s, 1 mm/s if not given) is where it comes near its full size, below it the joint creeps. With ``sticks`` it
    does not: a simulation finds when the joint sticks and slides, and holds it meanwhile.
    """
    what = f"{m.name}: force '{name}'"
    known = own_joint(m, joint, f"force '{name}'")
    if known.kind.pair is None:
        raise ModelError(
            f"{what}: '{known.name}' is a {known.kind.name}; friction needs one of revolute, prismatic, pin_in_slot"
        )
    params = amounts_given(
        m, name, coefficient=coefficient, viscous=viscous, radius=radius, length=length, preload=preload
    )
    params["static"] = params["coefficient"] if static is None else amounts_given(m, name, static=static)["static"]
    params |= {**above_zero(m, name, stribeck=stribeck), "sticks": bool(sticks)}
    if not sticks:
        params |= above_zero(m, name, slip_speed=1e-3 if slip_speed is None else slip_speed)
    elif slip_speed is not None:
        raise ModelError(f"{what}: a joint that sticks does not creep; give slip_speed or sticks=True, not both")
    if (params["radius"] > 0) != (known.kind.pair == "pin"):
        raise ModelError(f"{what}: a revolute joint needs the radius of its pin (m), and no other has one")
    if params["length"] > 0 and known.kind.pair != "guide":
        raise ModelError(f"{what}: a length of guide (m) is of prismatic joints alone")
    params["joint"] = known.name
    return add_force(m, FRICTION, name, known.i, known.j, params)
