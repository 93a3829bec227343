"""The compiled evaluation of interactions: the relative state in, force and torque out.

d  = p_j - p_i;   u unit axis of marker i, n = u_perp;   x = u . d,  y = n . d,  a = theta_j - theta_i + offset
x' = u . d' + omega_i y,   y' = n . d' - omega_i x,   a' = omega_j - omega_i
on body j: F at marker j and T; on body i: -F at the same point and -T;   power = F . (x', y') + T a'
"""

from __future__ import annotations

from mbsd.compiling.jit import lazy
from mbsd.equations.interactions.law import FX, FY, LAW, LAW_RATE, OMEGA, TIME, TORQUE, VX, VY
from mbsd.equations.laws import law_at
from mbsd.equations.relative.equation import OWN, A, X, Y, evaluate

GEOMETRY = 7
"""Numbers of an interaction before its own."""


@lazy(float)
def apply_interactions(interaction, given, state, exchange, laws, law, t, q, v, cos_sin, load):
    """Add the generalised forces of all interactions to load (3 nb,); cos_sin (nb, 2) turns the bodies.

    The first four and ``law`` are those of Loads. Returns their power (W).
    """
    out = exchange[1]
    power = 0.0
    for k in range(interaction.shape[0]):
        first = interaction[k, 0]
        second = interaction[k, 1]
        at = interaction[k, 3]
        i = 3 * first
        j = 3 * second
        c = cos_sin[first, 0]
        s = cos_sin[first, 1]
        arm_ix = c * given[at] - s * given[at + 1]
        arm_iy = s * given[at] + c * given[at + 1]
        ux = c * given[at + 2] - s * given[at + 3]
        uy = s * given[at + 2] + c * given[at + 3]
        c = cos_sin[second, 0]
        s = cos_sin[second, 1]
        arm_jx = c * given[at + 4] - s * given[at + 5]
        arm_jy = s * given[at + 4] + c * given[at + 5]
        dx = q[j] + arm_jx - q[i] - arm_ix
        dy = q[j + 1] + arm_jy - q[i + 1] - arm_iy
        omega = v[i + 2]
        vx = v[j] - v[j + 2] * arm_jy - v[i] + omega * arm_iy
        vy = v[j + 1] + v[j + 2] * arm_jx - v[i + 1] - omega * arm_ix
        x = ux * dx + uy * dy
        y = ux * dy - uy * dx
        state[X] = x
        state[Y] = y
        state[A] = q[j + 2] - q[i + 2] + given[at + 6]
        state[VX] = ux * vx + uy * vy + omega * y
        state[VY] = ux * vy - uy * vx - omega * x
        state[OMEGA] = v[j + 2] - omega
        state[TIME] = t
        state[LAW] = 0.0
        state[LAW_RATE] = 0.0
        if interaction[k, 2] > 0:
            law_at(laws, interaction[k, 2], t, law)
            state[LAW] = law[0]
            state[LAW_RATE] = law[1]
        # functions count their own numbers from OWN
        evaluate(interaction[k, 4], given[at + GEOMETRY - OWN :], state, out)
        power += out[FX] * state[VX] + out[FY] * state[VY] + out[TORQUE] * state[OMEGA]
        fx = out[FX] * ux - out[FY] * uy
        fy = out[FX] * uy + out[FY] * ux
        load[j] += fx
        load[j + 1] += fy
        load[j + 2] += out[TORQUE] + arm_jx * fy - arm_jy * fx
        load[i] -= fx
        load[i + 1] -= fy
        load[i + 2] -= out[TORQUE] + (arm_ix + dx) * fy - (arm_iy + dy) * fx
    return power
