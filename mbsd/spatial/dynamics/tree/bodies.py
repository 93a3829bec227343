"""Articulated bodies: rates' accelerations of a tree in O(n), and rows of cut joints through the same factors.

From the leaves on, of the columns S of each joint, the last first:

    U = I S,   D = S . U,   u = y - S . p;    I -= U U^T / D,   p += U u / D;    then both are added to the parent

and from the root on  z'' = (u - U . A) / D,  A += S z''.  I begins as the inertia of the body, p as the force that it
needs while rates stay, less what acts on it. So U and D are factors of the mass matrix, M = L D L^T in the order of the
tree, and u is L^-1 of what is on the right. An inertia is [[A, B], [B^T, C]] in 21 numbers: A and
C by their lower triangles, then B. A row of J is passed down likewise, as a force of its two bodies:

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
from mbsd.spatial.dynamics.tree.triples import add_part, part_of, plus, scaled, set_part, times


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
def _begin_inertia(out, mass, moment, m, r):
    """Fill the inertia (21,) of a body about the origin, its centre at r: A = I + m (r^2 - r r^T), B = m r x, C = m."""
    x, y, z = r[0], r[1], r[2]
    square = mass * (x * x + y * y + z * z)
    at = 0
    for i in range(3):
        for j in range(i + 1):
            value = m[i, 0] * moment[0] * m[j, 0] + m[i, 1] * moment[1] * m[j, 1] + m[i, 2] * moment[2] * m[j, 2]
            out[at] = value - mass * r[i] * r[j] + (square if i == j else 0.0)
            out[at + 6] = mass if i == j else 0.0
            at += 1
    x, y, z = mass * x, mass * y, mass * z
    out[12], out[13], out[14] = 0.0, -z, y
    out[15], out[16], out[17] = z, 0.0, -x
    out[18], out[19], out[20] = -y, x, 0.0


@inlined
def _take_square(m, at, a, b, x, y):
    """Take a x^T + b y^T, where it is symmetric, from six numbers."""
    m[at] -= a[0] * x[0] + b[0] * y[0]
    m[at + 1] -= a[1] * x[0] + b[1] * y[0]
    m[at + 2] -= a[1] * x[1] + b[1] * y[1]
    m[at + 3] -= a[2] * x[0] + b[2] * y[0]
    m[at + 4] -= a[2] * x[1] + b[2] * y[1]
    m[at + 5] -= a[2] * x[2] + b[2] * y[2]


@inlined
def _take_row(m, at, a, b, x, y):
    """Take a x + b y from three numbers."""
    m[at] -= a * x[0] + b * y[0]
    m[at + 1] -= a * x[1] + b * y[1]
    m[at + 2] -= a * x[2] + b * y[2]


@internal
def _share_columns(m, columns):
    """Fill U and 1 / D of the columns of a joint, and take their freedoms from an inertia m (21,)."""
    count = columns.shape[0]
    for k in range(count):
        s = columns[k]
        a, b = part_of(s, AXIS_OF), part_of(s, AXIS_OF + 3)
        set_part(
            s, SHARE,
            m[0] * a[0] + m[1] * a[1] + m[3] * a[2] + (m[12] * b[0] + m[13] * b[1] + m[14] * b[2]),
            m[1] * a[0] + m[2] * a[1] + m[4] * a[2] + (m[15] * b[0] + m[16] * b[1] + m[17] * b[2]),
            m[3] * a[0] + m[4] * a[1] + m[5] * a[2] + (m[18] * b[0] + m[19] * b[1] + m[20] * b[2]),
        )  # fmt: skip
        set_part(
            s, SHARE + 3,
            m[12] * a[0] + m[15] * a[1] + m[18] * a[2] + (m[6] * b[0] + m[7] * b[1] + m[9] * b[2]),
            m[13] * a[0] + m[16] * a[1] + m[19] * a[2] + (m[7] * b[0] + m[8] * b[1] + m[10] * b[2]),
            m[14] * a[0] + m[17] * a[1] + m[20] * a[2] + (m[9] * b[0] + m[10] * b[1] + m[11] * b[2]),
        )  # fmt: skip
    for k in range(count - 1, -1, -1):
        s = columns[k]
        u, t = part_of(s, SHARE), part_of(s, SHARE + 3)
        inverse = 1.0 / (times(s, AXIS_OF, u) + times(s, AXIS_OF + 3, t))
        s[INVERSE] = inverse
        for j in range(k):
            part = -inverse * (times(columns[j], AXIS_OF, u) + times(columns[j], AXIS_OF + 3, t))
            add_part(columns[j], SHARE, part, u)
            add_part(columns[j], SHARE + 3, part, t)


@internal
def _pass_on(m, columns, parent):
    """Add what a joint passes on of an inertia m (21,), which is spent, to that of the parent; columns go in pairs."""
    count = columns.shape[0]
    none = (0.0, 0.0, 0.0)
    for k in range(0, count, 2):
        s = columns[k]
        u, t = part_of(s, SHARE), part_of(s, SHARE + 3)
        a, b = scaled(u, s[INVERSE]), scaled(t, s[INVERSE])
        v, w, c, d = none, none, none, none
        if k + 1 < count:
            s = columns[k + 1]
            v, w = part_of(s, SHARE), part_of(s, SHARE + 3)
            c, d = scaled(v, s[INVERSE]), scaled(w, s[INVERSE])
        _take_square(m, 0, a, c, u, v)
        _take_square(m, 6, b, d, t, w)
        _take_row(m, 12, a[0], c[0], t, w)
        _take_row(m, 15, a[1], c[1], t, w)
        _take_row(m, 18, a[2], c[2], t, w)
    for k in range(21):
        parent[k] += m[k]


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
        p, f = part_of(body[b], PUSH), part_of(body[b], PUSH + 3)
        for k in range(first + tree.index[b, COUNT] - 1, first - 1, -1):
            s = work.column[k]
            u = -(times(s, AXIS_OF, p) + times(s, AXIS_OF + 3, f))
            s[LEFT] = u
            u *= s[INVERSE]
            p, f = plus(p, u, part_of(s, SHARE)), plus(f, u, part_of(s, SHARE + 3))
        if parent > 0:
            add_part(body[parent], PUSH, 1.0, p)
            add_part(body[parent], PUSH + 3, 1.0, f)


@internal
def release(tree, work, side, a):
    """Fill a (3 + nz,) from what is left of a side, and the accelerations of bodies that it makes."""
    body = work.body
    for i in range(tree.order.shape[0]):
        b = tree.order[i]
        parent = tree.index[b, PARENT]
        first = tree.index[b, FIRST_Z]
        w, v = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        if parent > 0:
            w, v = part_of(body[parent], MOTION), part_of(body[parent], MOTION + 3)
        for k in range(first, first + tree.index[b, COUNT]):
            s = work.column[k - 3]
            gain = (s[LEFT + side] - (times(s, SHARE, w) + times(s, SHARE + 3, v))) * s[INVERSE]
            a[k] = gain
            w, v = plus(w, gain, part_of(s, AXIS_OF)), plus(v, gain, part_of(s, AXIS_OF + 3))
        set_part(body[b], MOTION, w[0], w[1], w[2])
        set_part(body[b], MOTION + 3, v[0], v[1], v[2])


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
        p, f = part_of(body[b], FLOW), part_of(body[b], FLOW + 3)
        for k in range(first + tree.index[b, COUNT] - 1, first - 1, -1):
            s = work.column[k]
            part = y[k] + times(s, AXIS_OF, p) + times(s, AXIS_OF + 3, f)
            y[k] = part
            part *= -s[INVERSE]
            p, f = plus(p, part, part_of(s, SHARE)), plus(f, part, part_of(s, SHARE + 3))
        if parent > 0:
            add_part(body[parent], FLOW, 1.0, p)
            add_part(body[parent], FLOW + 3, 1.0, f)
