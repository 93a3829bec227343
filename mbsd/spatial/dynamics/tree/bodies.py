"""Articulated bodies: rates' accelerations of a tree in O(n), and rows of cut joints through the same factors.

From the leaves on, of the columns S of each joint, the last first:

    U = I S,   D = S . U,   u = y - S . p;    I -= U U^T / D,   p += U u / D;    then both are added to the parent

and from the root on  z'' = (u - U . A) / D,  A += S z''.  I begins as the inertia of the body, p as the force that it
needs while rates stay, less what acts on it. So U and D are factors of the mass matrix, M = L D L^T in the order of the
tree, and u is L^-1 of what is on the right. A row of J is passed down likewise, as a force of its two bodies:

    Y = L^-1 J^T,   S = Y^T D^-1 Y,   S lam = Y^T D^-1 u + J bend - gamma,   u -= Y lam

Source: Featherstone 2008, Rigid Body Dynamics Algorithms, ch. 7, 8.
"""

from __future__ import annotations

from mbsd.compiling.jit import inlined, internal
from mbsd.spatial.dynamics.tree.arrays import (
    AXIS_OF,
    COUNT,
    FIRST_Z,
    FLOW,
    INVERSE,
    LEFT,
    MOTION,
    PARENT,
    PUSH,
    REACH,
    SHARE,
)


@internal
def weigh(tree, work, system, ws, load):
    """Fill the forces that bodies need at their rates, less load (3 + 6 n,) and weight, about the origins."""
    body = work.body
    v = work.rate
    a = work.bend
    for i in range(tree.order.shape[0]):
        b = tree.order[i]
        c = 6 * b - 3
        m = ws.rotation[b]
        mass = system.mass[b]
        moment = system.inertia[b]
        x = mass * (a[c] - system.gravity[0]) - load[c]
        y = mass * (a[c + 1] - system.gravity[1]) - load[c + 1]
        z = mass * (a[c + 2] - system.gravity[2]) - load[c + 2]
        w0 = m[0, 0] * v[c + 3] + m[1, 0] * v[c + 4] + m[2, 0] * v[c + 5]
        w1 = m[0, 1] * v[c + 3] + m[1, 1] * v[c + 4] + m[2, 1] * v[c + 5]
        w2 = m[0, 2] * v[c + 3] + m[1, 2] * v[c + 4] + m[2, 2] * v[c + 5]
        t0 = m[0, 0] * a[c + 3] + m[1, 0] * a[c + 4] + m[2, 0] * a[c + 5]
        t1 = m[0, 1] * a[c + 3] + m[1, 1] * a[c + 4] + m[2, 1] * a[c + 5]
        t2 = m[0, 2] * a[c + 3] + m[1, 2] * a[c + 4] + m[2, 2] * a[c + 5]
        t0 = moment[0] * t0 + (moment[2] - moment[1]) * w1 * w2
        t1 = moment[1] * t1 + (moment[0] - moment[2]) * w2 * w0
        t2 = moment[2] * t2 + (moment[1] - moment[0]) * w0 * w1
        r = body[b, REACH : REACH + 3]
        body[b, PUSH] = m[0, 0] * t0 + m[0, 1] * t1 + m[0, 2] * t2 - load[c + 3] + r[1] * z - r[2] * y
        body[b, PUSH + 1] = m[1, 0] * t0 + m[1, 1] * t1 + m[1, 2] * t2 - load[c + 4] + r[2] * x - r[0] * z
        body[b, PUSH + 2] = m[2, 0] * t0 + m[2, 1] * t1 + m[2, 2] * t2 - load[c + 5] + r[0] * y - r[1] * x
        body[b, PUSH + 3] = x
        body[b, PUSH + 4] = y
        body[b, PUSH + 5] = z


@internal
def _begin_inertia(inertia, mass, moment, m, r):
    """Fill the inertia (6, 6) of a body about the origin, its centre at r: [[I, h x], [-h x, m]]."""
    x, y, z = r[0], r[1], r[2]
    square = x * x + y * y + z * z
    for i in range(3):
        for j in range(i + 1):
            value = m[i, 0] * moment[0] * m[j, 0] + m[i, 1] * moment[1] * m[j, 1] + m[i, 2] * moment[2] * m[j, 2]
            value -= mass * r[i] * r[j]
            if i == j:
                value += mass * square
            inertia[i, j] = value
            inertia[j, i] = value
            inertia[3 + i, 3 + j] = 0.0
            inertia[3 + j, 3 + i] = 0.0
        inertia[3 + i, 3 + i] = mass
        inertia[i, 3 + i] = 0.0
        inertia[3 + i, i] = 0.0
    x *= mass
    y *= mass
    z *= mass
    inertia[0, 4] = inertia[4, 0] = -z
    inertia[0, 5] = inertia[5, 0] = y
    inertia[1, 3] = inertia[3, 1] = z
    inertia[1, 5] = inertia[5, 1] = -x
    inertia[2, 3] = inertia[3, 2] = -y
    inertia[2, 4] = inertia[4, 2] = x


@inlined
def _times(s, at, u0, u1, u2, u3, u4, u5):
    """Return s[at : at + 6] . u."""
    return s[at] * u0 + s[at + 1] * u1 + s[at + 2] * u2 + (s[at + 3] * u3 + s[at + 4] * u4 + s[at + 5] * u5)


@inlined
def _down(m, c, s0, s1, s2, s3, s4, s5):
    """Return a column of a matrix (6, 6) times s."""
    return m[0, c] * s0 + m[1, c] * s1 + m[2, c] * s2 + m[3, c] * s3 + m[4, c] * s4 + m[5, c] * s5


@inlined
def _take(row, part, u0, u1, u2, u3, u4, u5):
    """Take u, ``part`` times, from row[:6]."""
    row[0] -= part * u0
    row[1] -= part * u1
    row[2] -= part * u2
    row[3] -= part * u3
    row[4] -= part * u4
    row[5] -= part * u5


@internal
def _share_columns(inertia, columns):
    """Fill U and 1 / D of the columns of a joint."""
    for k in range(columns.shape[0]):
        s = columns[k]
        s0, s1, s2, s3, s4, s5 = s[0], s[1], s[2], s[3], s[4], s[5]
        u0 = _down(inertia, 0, s0, s1, s2, s3, s4, s5)
        u1 = _down(inertia, 1, s0, s1, s2, s3, s4, s5)
        u2 = _down(inertia, 2, s0, s1, s2, s3, s4, s5)
        u3 = _down(inertia, 3, s0, s1, s2, s3, s4, s5)
        u4 = _down(inertia, 4, s0, s1, s2, s3, s4, s5)
        u5 = _down(inertia, 5, s0, s1, s2, s3, s4, s5)
        s[SHARE], s[SHARE + 1], s[SHARE + 2], s[SHARE + 3], s[SHARE + 4], s[SHARE + 5] = u0, u1, u2, u3, u4, u5
    for k in range(columns.shape[0] - 1, -1, -1):
        s = columns[k]
        u0, u1, u2, u3, u4, u5 = s[SHARE], s[SHARE + 1], s[SHARE + 2], s[SHARE + 3], s[SHARE + 4], s[SHARE + 5]
        inverse = 1.0 / _times(s, AXIS_OF, u0, u1, u2, u3, u4, u5)
        s[INVERSE] = inverse
        for j in range(k):
            part = inverse * _times(columns[j], AXIS_OF, u0, u1, u2, u3, u4, u5)
            _take(columns[j, SHARE : SHARE + 6], part, u0, u1, u2, u3, u4, u5)


@internal
def _pass_on(inertia, columns, parent):
    """Add what a joint passes on of an inertia (6, 6) to that of the parent."""
    for r in range(6):
        m = inertia[r]
        m0, m1, m2, m3, m4, m5 = m[0], m[1], m[2], m[3], m[4], m[5]
        for k in range(columns.shape[0]):
            s = columns[k]
            part = s[SHARE + r] * s[INVERSE]
            m0 -= part * s[SHARE]
            m1 -= part * s[SHARE + 1]
            m2 -= part * s[SHARE + 2]
            m3 -= part * s[SHARE + 3]
            m4 -= part * s[SHARE + 4]
            m5 -= part * s[SHARE + 5]
        _take(parent[r], -1.0, m0, m1, m2, m3, m4, m5)


@internal
def factor_tree(tree, work, system, ws):
    """Fill U and D of all columns."""
    inertia = work.inertia
    last = tree.order.shape[0] - 1
    for i in range(last + 1):
        b = tree.order[i]
        r = work.body[b, REACH : REACH + 3]
        _begin_inertia(inertia[b], system.mass[b], system.inertia[b], ws.rotation[b], r)
    for i in range(last, -1, -1):
        b = tree.order[i]
        parent = tree.index[b, PARENT]
        first = tree.index[b, FIRST_Z] - 3
        columns = work.column[first : first + tree.index[b, COUNT]]
        _share_columns(inertia[b], columns)
        if parent > 0:
            _pass_on(inertia[b], columns, inertia[parent])


@internal
def gather(tree, work):
    """Fill u of all columns from the forces that bodies need, which are spent."""
    body = work.body
    for i in range(tree.order.shape[0] - 1, -1, -1):
        b = tree.order[i]
        parent = tree.index[b, PARENT]
        first = tree.index[b, FIRST_Z] - 3
        p = body[b, PUSH : PUSH + 6]
        p0, p1, p2, p3, p4, p5 = p[0], p[1], p[2], p[3], p[4], p[5]
        for k in range(first + tree.index[b, COUNT] - 1, first - 1, -1):
            s = work.column[k]
            u = -_times(s, AXIS_OF, p0, p1, p2, p3, p4, p5)
            s[LEFT] = u
            u *= s[INVERSE]
            p0 += u * s[SHARE]
            p1 += u * s[SHARE + 1]
            p2 += u * s[SHARE + 2]
            p3 += u * s[SHARE + 3]
            p4 += u * s[SHARE + 4]
            p5 += u * s[SHARE + 5]
        if parent > 0:
            _take(body[parent, PUSH : PUSH + 6], -1.0, p0, p1, p2, p3, p4, p5)


@internal
def release(tree, work, side, a):
    """Fill a (3 + nz,) from what is left of a side, and the accelerations of bodies that it makes."""
    body = work.body
    for i in range(tree.order.shape[0]):
        b = tree.order[i]
        parent = tree.index[b, PARENT]
        first = tree.index[b, FIRST_Z]
        m0 = m1 = m2 = m3 = m4 = m5 = 0.0
        if parent > 0:
            m = body[parent, MOTION : MOTION + 6]
            m0, m1, m2, m3, m4, m5 = m[0], m[1], m[2], m[3], m[4], m[5]
        for k in range(first, first + tree.index[b, COUNT]):
            s = work.column[k - 3]
            gain = (s[LEFT + side] - _times(s, SHARE, m0, m1, m2, m3, m4, m5)) * s[INVERSE]
            a[k] = gain
            m0 += gain * s[0]
            m1 += gain * s[1]
            m2 += gain * s[2]
            m3 += gain * s[3]
            m4 += gain * s[4]
            m5 += gain * s[5]
        m = body[b, MOTION : MOTION + 6]
        m[0], m[1], m[2], m[3], m[4], m[5] = m0, m1, m2, m3, m4, m5


@internal
def spread_row(tree, work, system, ws, row):
    """Fill Y of a row of cut joints."""
    body = work.body
    y = work.spread[row]
    for k in range(y.shape[0]):
        y[k] = 0.0
    for n in range(tree.linear.shape[0]):
        if tree.linear[n, 0] == row:
            y[tree.linear[n, 1] - 3] += tree.factor[n]
    for n in range(tree.begin[row], tree.begin[row + 1]):
        b = tree.path[n]
        for j in range(6):
            body[b, FLOW + j] = 0.0
    for side in range(system.row_body.shape[1]):
        b = system.row_body[row, side]
        if b > 0:
            f = ws.jac[row, 6 * side : 6 * side + 6]
            r = body[b, REACH : REACH + 3]
            body[b, FLOW] += f[3] + r[1] * f[2] - r[2] * f[1]
            body[b, FLOW + 1] += f[4] + r[2] * f[0] - r[0] * f[2]
            body[b, FLOW + 2] += f[5] + r[0] * f[1] - r[1] * f[0]
            for j in range(3):
                body[b, FLOW + 3 + j] += f[j]
    for n in range(tree.begin[row], tree.begin[row + 1]):
        b = tree.path[n]
        parent = tree.index[b, PARENT]
        first = tree.index[b, FIRST_Z] - 3
        f = body[b, FLOW : FLOW + 6]
        f0, f1, f2, f3, f4, f5 = f[0], f[1], f[2], f[3], f[4], f[5]
        for k in range(first + tree.index[b, COUNT] - 1, first - 1, -1):
            s = work.column[k]
            part = y[k] + _times(s, AXIS_OF, f0, f1, f2, f3, f4, f5)
            y[k] = part
            part *= s[INVERSE]
            f0 -= part * s[SHARE]
            f1 -= part * s[SHARE + 1]
            f2 -= part * s[SHARE + 2]
            f3 -= part * s[SHARE + 3]
            f4 -= part * s[SHARE + 4]
            f5 -= part * s[SHARE + 5]
        if parent > 0:
            _take(body[parent, FLOW : FLOW + 6], -1.0, f0, f1, f2, f3, f4, f5)
