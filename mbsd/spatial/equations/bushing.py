"""Bushing: stiffness and damping of six directions between two frames.

    x = (d, phi)              d: place of j in the axes of i;  phi: rotation vector from i to j, |phi| < pi
    s = K x + C x'            force -s_d and moment -J^-T s_phi on j, in the axes of i; body i takes the opposite
    phi' = J^-1 w             J^-1 = 1 - [phi] / 2 + c [phi]^2,  c = 1 / a^2 - (1 + cos a) / (2 a sin a),  a = |phi|

The energy of K is x^T K x / 2, exactly. Source: Sola 2018, A micro Lie theory, arXiv 1812.01537 (J^-1).
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal
from mbsd.spatial.equations.calls import NUMBERS, law, to_frame, to_world

SMALL = 1e-4


@internal
def _rotation_vector(inputs):
    """Return phi in the axes of i, and its length (rad)."""
    a0 = inputs[3]
    a1 = inputs[4]
    a2 = inputs[5]
    a3 = inputs[6]
    b0 = inputs[10]
    b1 = inputs[11]
    b2 = inputs[12]
    b3 = inputs[13]
    real = a0 * b0 + a1 * b1 + a2 * b2 + a3 * b3
    px = a0 * b1 - a1 * b0 - a2 * b3 + a3 * b2
    py = a0 * b2 - a2 * b0 - a3 * b1 + a1 * b3
    pz = a0 * b3 - a3 * b0 - a1 * b2 + a2 * b1
    half = math.sqrt(px * px + py * py + pz * pz)
    angle = 2.0 * math.atan2(half, abs(real))
    scale = 2.0 if half < 1e-150 else angle / half
    if real < 0.0:
        scale = -scale
    px *= scale
    py *= scale
    pz *= scale
    return px, py, pz, angle


@law
def bushing(t, inputs, outputs):
    """Put out wrenches of a bushing; numbers: K (36), C (36) by rows."""
    dx, dy, dz = to_frame(inputs, 3, inputs[7] - inputs[0], inputs[8] - inputs[1], inputs[9] - inputs[2])
    px, py, pz, angle = _rotation_vector(inputs)
    if angle < SMALL:
        c = 1.0 / 12.0 + angle * angle / 720.0
    else:
        c = 1.0 / (angle * angle) - (1.0 + math.cos(angle)) / (2.0 * angle * math.sin(angle))
    # rates in the axes of i, as seen from it
    w1, w2, w3 = to_frame(inputs, 3, inputs[17], inputs[18], inputs[19])
    v1, v2, v3 = to_frame(inputs, 3, inputs[20] - inputs[14], inputs[21] - inputs[15], inputs[22] - inputs[16])
    u1, u2, u3 = to_frame(inputs, 3, inputs[23] - inputs[17], inputs[24] - inputs[18], inputs[25] - inputs[19])
    v1 -= w2 * dz - w3 * dy
    v2 -= w3 * dx - w1 * dz
    v3 -= w1 * dy - w2 * dx
    q1 = py * u3 - pz * u2
    q2 = pz * u1 - px * u3
    q3 = px * u2 - py * u1
    r1 = u1 - 0.5 * q1 + c * (py * q3 - pz * q2)
    r2 = u2 - 0.5 * q2 + c * (pz * q1 - px * q3)
    r3 = u3 - 0.5 * q3 + c * (px * q2 - py * q1)
    s1 = s2 = s3 = s4 = s5 = s6 = energy = 0.0
    for k in range(6):
        at = NUMBERS + 6 * k
        stored = inputs[at] * dx + inputs[at + 1] * dy + inputs[at + 2] * dz
        stored += inputs[at + 3] * px + inputs[at + 4] * py + inputs[at + 5] * pz
        at += 36
        lost = inputs[at] * v1 + inputs[at + 1] * v2 + inputs[at + 2] * v3
        lost += inputs[at + 3] * r1 + inputs[at + 4] * r2 + inputs[at + 5] * r3
        if k == 0:
            s1 = stored + lost
            energy += 0.5 * stored * dx
        elif k == 1:
            s2 = stored + lost
            energy += 0.5 * stored * dy
        elif k == 2:
            s3 = stored + lost
            energy += 0.5 * stored * dz
        elif k == 3:
            s4 = stored + lost
            energy += 0.5 * stored * px
        elif k == 4:
            s5 = stored + lost
            energy += 0.5 * stored * py
        else:
            s6 = stored + lost
            energy += 0.5 * stored * pz
    q1 = py * s6 - pz * s5
    q2 = pz * s4 - px * s6
    q3 = px * s5 - py * s4
    m1 = -(s4 + 0.5 * q1 + c * (py * q3 - pz * q2))
    m2 = -(s5 + 0.5 * q2 + c * (pz * q1 - px * q3))
    m3 = -(s6 + 0.5 * q3 + c * (px * q2 - py * q1))
    outputs[6], outputs[7], outputs[8] = to_world(inputs, 3, -s1, -s2, -s3)
    outputs[9], outputs[10], outputs[11] = to_world(inputs, 3, m1, m2, m3)
    f1, f2, f3 = to_world(
        inputs, 3, -(m1 - (dy * s3 - dz * s2)), -(m2 - (dz * s1 - dx * s3)), -(m3 - (dx * s2 - dy * s1))
    )
    outputs[3] = f1
    outputs[4] = f2
    outputs[5] = f3
    for k in range(3):
        outputs[k] = -outputs[6 + k]
    outputs[12] = energy
