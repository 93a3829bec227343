"""Friction of a joint from its actual reaction: Coulomb with Stribeck's rise at low speed, and viscous.

    mu(s) = mu_k + (mu_s - mu_k) exp(-(s / s_S)^2)           s: sliding speed
    F     = -mu(s) tanh(s / s_0) (N + N_0) - c s             N_0: preload, as of a spring that presses
    pin:    s = r omega,  torque = -mu(s) tanh(s / s_0) (N + N_0) r - c omega;    N = |reaction|, r its radius
    guide:  N = max(|R|, 2 |M| / L)      R across the guide, M its torque at marker j, L how long the slider is guided:
                                         two edges L apart carry R and M, and N is the sum of what they carry
    slot:   N = |reaction|

The smooth form: below s_0 joints creep instead of sticking. The form by events has sign(s) in place of tanh: a
simulation finds the time when s = 0, where the joint sticks as long as |F| <= mu_s (N + N_0), of a pin times r, holds
it with a row of J, and finds the time when it slides (dynamics/joint_sticks.py, stick_slip.py). A known motion, as in
a sweep, tells no friction at rest: it is counted as zero in both forms.

The reactions come from the multipliers, found together with the friction (joint_friction.py). Redundant joints share
loads as the program happens to find them, and so does their friction. Sources: Armstrong-Helouvry, Dupont, Canudas de
Wit 1994, Automatica 30 (Stribeck); Haug 1989, ch. 8; Pfeiffer, Glocker 1996, ch. 5 (events).
"""

from __future__ import annotations

from typing import Any

from mbsd.model.forces.kind import ForceKind, register


def _example(m: Any, i: Any, j: Any) -> None:
    m.revolute("pin", i, j)
    m.friction("example", "pin", 0.3, static=0.4, viscous=0.05, radius=0.2, slip_speed=0.1, stribeck=0.3)


FRICTION = register(ForceKind("friction", example=_example, of_reactions=True))
