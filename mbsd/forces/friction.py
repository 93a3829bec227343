"""Dry and viscous friction in a joint, on its actual reaction.

    pin      T = -r mu(s) N - c omega     s = r omega,  omega = omega_j - omega_i;     N = |R| + N0
    slide    F =   -mu(s) N - c s         s: speed of marker j on the axis of marker i;  N = max(|R|, 2 |M| / l) + N0

    mu(s) = (mu_k + (mu_s - mu_k) exp(-(s / v_s)^2)) tanh(s / v_0)

R, M: force and couple of the joint, r radius of the pin, l length of the guide that a prismatic joint bears on at its
two ends, N0 preload, mu_k and mu_s kinetic and static coefficient, v_s Stribeck's speed, c viscous coefficient. The
tanh makes the law smooth: a joint at rest creeps with a speed below v_0 instead of sticking. T and F act on the second
body, the opposite on the first. The reactions depend on the friction; both are found together (mbsd/joint_friction.py).

Source: Armstrong-Helouvry, Dupont, Canudas de Wit 1994, Automatica 30 (7); Haug 1989, ch. 6.
"""

from __future__ import annotations

from mbsd.forces.kind import ForceKind, register

FRICTION = register(
    ForceKind(
        "friction",
        example=lambda m, i, j: m.friction("example", m.revolute("pin", i, j), 0.2, static=0.3, radius=0.02),
        of_reaction=True,
    )
)
