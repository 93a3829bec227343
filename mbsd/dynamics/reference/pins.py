"""Many bodies held by pins alone: the same equations without the zeros and ones of J.

    J     = [-I, -s_perp_i]  and  [I, s_perp_j]      of a pin between markers i and j
    gamma = omega_j^2 s_j - omega_i^2 s_i

A block is a pin, of which two numbers change with the pose of each body. All that is left out is exact, so numbers are
those of schur.py, acceleration.py and projection.py to the last digit, and a chain takes a quarter less time. Compiled
when a mechanism of many pins first asks.
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.reference.schur import INDEX, Schur, eliminate, solve_schur
from mbsd.equations.system import System

MANY = 16
"""Pins from which on it pays in single simulations to compile these kernels beside the others."""


def with_pins(schur: Schur, system: System, rows: int, least: int = MANY) -> Schur:
    """The sequence with the markers of its pins, if the first ``rows`` of J are those of ``least`` pins or more.

    They must be all rows in the sequence, and none of them left out.
    """
    (first, second), count = schur.rows.T, len(schur.rows)
    if count < least or len(system.point) != count or rows != 2 * count or (second != first + 1).any():
        return schur
    pin = np.empty(2 * count, np.int64)
    pin[system.point[:, 2]] = np.arange(count)
    return schur._replace(pins=np.ascontiguousarray(system.point[pin[first], :2], INDEX))


@internal
def _couple(schur, fac, begin):
    """Add to S what pins on one body have to do with each other: products from ``begin`` on."""
    arm = fac.arm
    weighted = fac.weighted
    value = fac.value
    for e in range(begin, schur.product.shape[0]):
        t = schur.product[e, 0]
        i = schur.product[e, 1]
        j = schur.product[e, 2]
        sign = arm[i, 2]
        a0 = arm[i, 0]
        a1 = arm[i, 1]
        w0 = weighted[j, 0]
        w1 = weighted[j, 1]
        value[t, 0] += sign * weighted[j, 2] + a0 * w0
        value[t, 1] += a0 * w1
        value[t, 2] += a1 * w0
        value[t, 3] += sign * weighted[j, 3] + a1 * w1


@lazy(float)
def factor_pins(schur, fac, cos_sin, marker_arm, q, v, inverse, lift):
    """Factor S at q (3 nb,) and leave gamma at v (3 nb,) as second right-hand side; returns as factor_schur.

    For each body of a pin fac.arm begins with (+-s_perp_x, +-s_perp_y, +-1), fac.weighted with the same times W^-1:
    (w_x, w_y, +-1 / m_x, +-1 / m_y).
    """
    arm = fac.arm
    weighted = fac.weighted
    value = fac.value
    low = fac.low
    gamma = fac.side
    count = schur.pins.shape[0]
    for b in range(1, cos_sin.shape[0]):
        theta = q[3 * b + 2]
        cos_sin[b, 0] = math.cos(theta)
        cos_sin[b, 1] = math.sin(theta)
    for e in range(count, value.shape[0]):
        value[e, 0] = 0.0
        value[e, 1] = 0.0
        value[e, 2] = 0.0
        value[e, 3] = 0.0
    between = 0
    for k in range(count):
        gamma[k, 0, 1] = 0.0
        gamma[k, 1, 1] = 0.0
        sign = -1.0
        v0 = 0.0
        v1 = 0.0
        v2 = 0.0
        v3 = 0.0
        for side in range(2):
            i = schur.pins[k, side]
            b = schur.bodies[k, side]
            c = cos_sin[b, 0]
            s = cos_sin[b, 1]
            x = c * marker_arm[i, 0] - s * marker_arm[i, 1]
            y = s * marker_arm[i, 0] + c * marker_arm[i, 1]
            omega = v[3 * b + 2]
            gamma[k, 0, 1] -= sign * (-omega * omega * x)
            gamma[k, 1, 1] -= sign * (-omega * omega * y)
            a = 2 * k + side
            a0 = -sign * y
            a1 = sign * x
            m0 = inverse[3 * b]
            m1 = inverse[3 * b + 1]
            w0 = a0 * inverse[3 * b + 2]
            w1 = a1 * inverse[3 * b + 2]
            arm[a, 0] = a0
            arm[a, 1] = a1
            arm[a, 2] = sign
            weighted[a, 0] = w0
            weighted[a, 1] = w1
            weighted[a, 2] = sign * m0
            weighted[a, 3] = sign * m1
            if b > 0:
                between += 1
                v0 += m0 + a0 * w0
                v1 += a0 * w1
                v2 += a1 * w0
                v3 += m1 + a1 * w1
            sign = 1.0
        v0 += lift * v0
        v3 += lift * v3
        value[k, 0] = v0
        value[k, 1] = v1
        value[k, 2] = v2
        value[k, 3] = v3
        low[k, 0] = v0
        low[k, 3] = v3
    _couple(schur, fac, between)
    return eliminate(schur, fac)


@lazy(None)
def solve_pins(schur, fac, inverse, force, a, lam):
    """Fill a (3 nb,) and lam (m,) from the loads in force (3 nb,), of which J^T lam is taken, after factor_pins."""
    arm = fac.arm
    y = fac.side
    count = schur.pins.shape[0]
    n3 = a.shape[0]
    for c in range(3, n3):
        a[c] = inverse[c] * force[c]
    for k in range(count):
        i = 3 * schur.bodies[k, 0]
        j = 3 * schur.bodies[k, 1]
        x0 = a[i + 2]
        x1 = a[j + 2]
        y[k, 0, 0] = -a[i] + arm[2 * k, 0] * x0 + a[j] + arm[2 * k + 1, 0] * x1 - y[k, 0, 1]
        y[k, 1, 0] = -a[i + 1] + arm[2 * k, 1] * x0 + a[j + 1] + arm[2 * k + 1, 1] * x1 - y[k, 1, 1]
    solve_schur(schur, fac, 1)
    for k in range(count):
        first = y[k, 0, 0]
        second = y[k, 1, 0]
        i = 3 * schur.bodies[k, 0]
        force[i] += first
        force[i + 1] += second
        force[i + 2] -= arm[2 * k, 0] * first + arm[2 * k, 1] * second
        i = 3 * schur.bodies[k, 1]
        force[i] -= first
        force[i + 1] -= second
        force[i + 2] -= arm[2 * k + 1, 0] * first + arm[2 * k + 1, 1] * second
        lam[schur.rows[k, 0]] = first
        lam[schur.rows[k, 1]] = second
    for c in range(3, n3):
        a[c] = inverse[c] * force[c] + 0.0


@lazy(None)
def change_by_pins(schur, fac, q, v, change):
    """Fill change (2, 3 nb), which W^-1 is still to be multiplied by, with what closes pins; after factor_pins."""
    arm = fac.arm
    y = fac.side
    count = schur.pins.shape[0]
    for k in range(count):
        i = 3 * schur.bodies[k, 0]
        j = 3 * schur.bodies[k, 1]
        y[k, 0, 0] = q[j] + arm[2 * k + 1, 1] - (q[i] - arm[2 * k, 1])
        y[k, 1, 0] = q[j + 1] - arm[2 * k + 1, 0] - (q[i + 1] + arm[2 * k, 0])
        y[k, 0, 1] = -v[i] + arm[2 * k, 0] * v[i + 2] + v[j] + arm[2 * k + 1, 0] * v[j + 2]
        y[k, 1, 1] = -v[i + 1] + arm[2 * k, 1] * v[i + 2] + v[j + 1] + arm[2 * k + 1, 1] * v[j + 2]
    solve_schur(schur, fac, 2)
    for c in range(change.shape[1]):
        change[0, c] = 0.0
        change[1, c] = 0.0
    for k in range(count):
        i = 3 * schur.bodies[k, 0]
        j = 3 * schur.bodies[k, 1]
        for n in range(2):
            first = y[k, 0, n]
            second = y[k, 1, n]
            change[n, i] += first
            change[n, i + 1] += second
            change[n, i + 2] -= arm[2 * k, 0] * first + arm[2 * k, 1] * second
            change[n, j] -= first
            change[n, j + 1] -= second
            change[n, j + 2] -= arm[2 * k + 1, 0] * first + arm[2 * k + 1, 1] * second
