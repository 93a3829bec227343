"""Places and directions of bodies in the world, their velocities, and accelerations without w'."""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined, internal


@inlined
def cross(a, b, out):
    """Fill out (3,) with a x b; out is neither of both."""
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@inlined
def dot(a, b):
    """Return a . b of vectors (3,)."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def make_unit(q, c):
    """Make Euler parameters q[c : c + 4] a unit; returns by how much they were none."""
    size = math.sqrt(q[c] ** 2 + q[c + 1] ** 2 + q[c + 2] ** 2 + q[c + 3] ** 2)
    for k in range(4):
        q[c + k] /= size
    return abs(size - 1.0)


@inlined
def add_turning(e0, e1, e2, e3, x, y, z, out, c):
    """Add e (0, w) / 2 to out[c : c + 4], of w in body axes."""
    out[c] -= 0.5 * (e1 * x + e2 * y + e3 * z)
    out[c + 1] += 0.5 * (e0 * x + e2 * z - e3 * y)
    out[c + 2] += 0.5 * (e0 * y + e3 * x - e1 * z)
    out[c + 3] += 0.5 * (e0 * z + e1 * y - e2 * x)


@inlined
def fill_rotation(w, x, y, z, m):
    """Fill the rotation m (3, 3) of Euler parameters of any length."""
    n = 1.0 / (w * w + x * x + y * y + z * z)
    m[0, 0] = (w * w + x * x - y * y - z * z) * n
    m[0, 1] = 2.0 * (x * y - w * z) * n
    m[0, 2] = 2.0 * (x * z + w * y) * n
    m[1, 0] = 2.0 * (x * y + w * z) * n
    m[1, 1] = (w * w - x * x + y * y - z * z) * n
    m[1, 2] = 2.0 * (y * z - w * x) * n
    m[2, 0] = 2.0 * (x * z - w * y) * n
    m[2, 1] = 2.0 * (y * z + w * x) * n
    m[2, 2] = (w * w - x * x - y * y + z * z) * n


@internal
def rotate_bodies(system, q, ws):
    """Fill rotations at coordinates q (3 + 7 n,); e need not be a unit."""
    for b in range(1, system.mass.shape[0]):
        c = 7 * b - 1
        fill_rotation(q[c], q[c + 1], q[c + 2], q[c + 3], ws.rotation[b])


@internal
def carry_vectors(system, q, ws):
    """Fill arms, places and axes at coordinates q (3 + 7 n,), whose rotations are known."""
    for p in range(system.arm_body.shape[0]):
        b = system.arm_body[p]
        m = ws.rotation[b]
        s = system.arm[p]
        for k in range(3):
            ws.arm[p, k] = m[k, 0] * s[0] + m[k, 1] * s[1] + m[k, 2] * s[2]
            ws.place[p, k] = ws.arm[p, k]
        if b > 0:
            for k in range(3):
                ws.place[p, k] += q[7 * b - 4 + k]
    for d in range(system.axis_body.shape[0]):
        m = ws.rotation[system.axis_body[d]]
        s = system.axis[d]
        for k in range(3):
            ws.axis[d, k] = m[k, 0] * s[0] + m[k, 1] * s[1] + m[k, 2] * s[2]


@internal
def turn_vectors(system, v, ws):
    """Fill rates and bends of places and axes at velocities v (3 + 6 n,), those of ground zero."""
    for p in range(system.arm_body.shape[0]):
        b = system.arm_body[p]
        rate = ws.rate[p]
        bend = ws.bend[p]
        if b == 0:
            for k in range(3):
                rate[k] = 0.0
                bend[k] = 0.0
        else:
            w = v[6 * b : 6 * b + 3]
            cross(w, ws.arm[p], rate)
            cross(w, rate, bend)
            for k in range(3):
                rate[k] += v[6 * b - 3 + k]
    for d in range(system.axis_body.shape[0]):
        b = system.axis_body[d]
        rate = ws.axis_rate[d]
        bend = ws.axis_bend[d]
        if b == 0:
            for k in range(3):
                rate[k] = 0.0
                bend[k] = 0.0
        else:
            w = v[6 * b : 6 * b + 3]
            cross(w, ws.axis[d], rate)
            cross(w, rate, bend)
