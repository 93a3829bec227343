"""Friction of joints and the reactions it depends on, found together.

    N = g(N):  friction by N -> a, lam by one more solution -> the normal forces of the joints

The fixed point is found with Anderson's acceleration of depth one, of a single joint the secant method:

    N_new = g - theta (g - g_old),   theta = <e, e - e_old> / |e - e_old|^2,   e = f (g - N)

Where there is none the mechanism jams, and the accelerations become NaN.
Source: Walker, Ni 2011, SIAM J. Numer. Anal. 49.
"""

from __future__ import annotations

import math

from mbsd.dynamics.balance import balance
from mbsd.jit import internal
from mbsd.joint_friction import SCALE, VISCOUS, friction_factor, friction_rate, normal_force, push

ROUNDS = 60
SETTLED = 1e-12
"""Friction may be wrong by this part of the largest multiplier."""
RATE, FACTOR, NORMAL, GAP, FOUND = 0, 1, 2, 3, 4
"""Columns of JointFriction.normal."""


@internal
def settle_friction(dyn, scratch, v, a, lam):
    """Add friction to a (3 nb,) and lam (m,), found without it; returns the power of friction (W)."""
    system = dyn.system
    friction = dyn.friction
    ws = scratch.ws
    now = friction.normal
    count = friction.table.shape[0]
    for k in range(count):
        rate = friction_rate(system, friction, k, v, ws)
        now[k, RATE] = rate
        now[k, FACTOR] = friction_factor(friction, k, rate)
        now[k, NORMAL] = 0.0
        push(system, friction, k, -friction.number[k, VISCOUS] * rate, ws, scratch.force)
    settled = False
    for step in range(ROUNDS):
        if step > 0:
            for _ in range(dyn.passes):
                balance(dyn, scratch, ws.right[0], a, lam)
        largest = 0.0
        for r in range(lam.shape[0]):
            largest = max(largest, abs(lam[r]))
        error = 0.0
        product = 0.0
        square = 0.0
        for k in range(count):
            gap = now[k, FACTOR] * (normal_force(friction, k, lam) - now[k, NORMAL])
            change = gap - now[k, GAP]
            product += gap * change
            square += change * change
            error = max(error, abs(gap)) if gap == gap else gap
        if step > 0 and error <= SETTLED * largest:
            settled = True
            break
        theta = product / square if step > 1 and square > 0.0 else 0.0
        for k in range(count):
            found = normal_force(friction, k, lam)
            normal = max(found - theta * (found - now[k, FOUND]), 0.0)
            now[k, GAP] = now[k, FACTOR] * (found - now[k, NORMAL])
            now[k, FOUND] = found
            amount = friction.number[k, SCALE] * now[k, FACTOR] * (normal - now[k, NORMAL])
            push(system, friction, k, amount, ws, scratch.force)
            now[k, NORMAL] = normal
    if not settled:
        for c in range(3, a.shape[0]):
            a[c] = math.nan
    power = 0.0
    for k in range(count):
        amount = friction.number[k, SCALE] * now[k, FACTOR] * now[k, NORMAL]
        power += (amount - friction.number[k, VISCOUS] * now[k, RATE]) * now[k, RATE]
    return power
