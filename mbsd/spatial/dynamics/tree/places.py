"""Poses, axes and velocities of the bodies of a tree, from the joints on.

    e_child = e_parent (c p + s p') [(c2 p2 + s2 p2')],   c, s = cos, sin of half the turn
    r_child = r_parent + arm + slide axis - own arm
    S       = (a, (P - O) x a) of a turn about a through P,  (0, a) of a slide along a
    V_child = V_parent + sum S z,   and while z stays  V'_child = V'_parent + sum V x S z

In the last sum V is the motion of the frame to which S is fixed. (w, v) x (u, s) = (w x u, w x s + v x u).
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined, internal
from mbsd.spatial.dynamics.tree.arrays import (
    ARM,
    AXIS,
    AXIS_OF,
    COUNT,
    CYLINDRICAL,
    FIRST_Q,
    FIRST_Z,
    FREE,
    KIND,
    MOTION,
    ORIGIN,
    OWN_ARM,
    OWN_AXIS,
    PARENT,
    PRISMATIC,
    REACH,
    REVOLUTE,
    ROOT,
    SECOND,
    SPHERICAL,
    TURN,
    UNIVERSAL,
    VELOCITY,
)
from mbsd.spatial.dynamics.tree.triples import add, cross, part_of, plus, scaled, set_part
from mbsd.spatial.equations.vectors import fill_rotation


@inlined
def _turned(n, at, c, s):
    """Return the quaternion c p + s p' of two in a row of numbers."""
    return (
        c * n[at] + s * n[at + 4],
        c * n[at + 1] + s * n[at + 5],
        c * n[at + 2] + s * n[at + 6],
        c * n[at + 3] + s * n[at + 7],
    )


@inlined
def _product(a, b):
    """Return the product of two quaternions."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


@inlined
def _carry(m, n, at):
    """Return the vector in the world of three numbers in principal axes."""
    return (
        m[0, 0] * n[at] + m[0, 1] * n[at + 1] + m[0, 2] * n[at + 2],
        m[1, 0] * n[at] + m[1, 1] * n[at + 1] + m[1, 2] * n[at + 2],
        m[2, 0] * n[at] + m[2, 1] * n[at + 1] + m[2, 2] * n[at + 2],
    )


@inlined
def _set_turn(s, a, x, y, z):
    """Fill the column s of a turn about a through a place (x, y, z) seen from the origin."""
    s[0] = a[0]
    s[1] = a[1]
    s[2] = a[2]
    s[3] = y * a[2] - z * a[1]
    s[4] = z * a[0] - x * a[2]
    s[5] = x * a[1] - y * a[0]


@internal
def _orient(tree, q, b, pose, m):
    """Fill Euler parameters of a body, and its rotation m; those of its parent are known."""
    kind = tree.index[b, KIND]
    first = tree.index[b, FIRST_Q]
    parent = tree.index[b, PARENT]
    n = tree.number[b]
    if kind == SPHERICAL:
        e = (q[first], q[first + 1], q[first + 2], q[first + 3])
    elif kind >= REVOLUTE:
        e = _turned(n, TURN, math.cos(0.5 * q[first]), math.sin(0.5 * q[first]))
        if kind == UNIVERSAL:
            e = _product(e, _turned(n, SECOND, math.cos(0.5 * q[first + 1]), math.sin(0.5 * q[first + 1])))
    else:
        e = (n[TURN], n[TURN + 1], n[TURN + 2], n[TURN + 3])
    if parent > 0:
        p = 7 * parent - 1
        e = _product((pose[p], pose[p + 1], pose[p + 2], pose[p + 3]), e)
    c = 7 * b - 1
    pose[c] = e[0]
    pose[c + 1] = e[1]
    pose[c + 2] = e[2]
    pose[c + 3] = e[3]
    fill_rotation(e[0], e[1], e[2], e[3], m)


@internal
def _place_free(tree, q, b, pose, m, body, column):
    """Fill pose and columns of a body that no joint of the tree holds."""
    first = tree.index[b, FIRST_Q]
    for k in range(7):
        pose[7 * b - 4 + k] = q[first + k]
    fill_rotation(q[first + 3], q[first + 4], q[first + 5], q[first + 6], m)
    for k in range(3):
        body[b, ORIGIN + k] = q[first + k]
        body[b, REACH + k] = 0.0
        for c in range(3):
            column[k, AXIS_OF + c] = 0.0
            column[k, AXIS_OF + 3 + c] = 1.0 if c == k else 0.0
            column[3 + k, AXIS_OF + c] = m[c, k]
            column[3 + k, AXIS_OF + 3 + c] = 0.0


@internal
def place_tree(tree, work, q, ws):
    """Fill poses, rotations and columns S at coordinates q (3 + nq,)."""
    pose = work.pose
    body = work.body
    for i in range(tree.order.shape[0]):
        b = tree.order[i]
        kind = tree.index[b, KIND]
        first = tree.index[b, FIRST_Z] - 3
        column = work.column[first : first + tree.index[b, COUNT]]
        m = ws.rotation[b]
        if kind == FREE:
            _place_free(tree, q, b, pose, m, body, column)
            continue
        _orient(tree, q, b, pose, m)
        parent = tree.index[b, PARENT]
        root = tree.index[b, ROOT]
        n = tree.number[b]
        base = ws.rotation[parent]
        x, y, z = _carry(base, n, ARM)
        if parent > 0:
            x += pose[7 * parent - 4]
            y += pose[7 * parent - 3]
            z += pose[7 * parent - 2]
        if b == root:
            body[b, ORIGIN] = x
            body[b, ORIGIN + 1] = y
            body[b, ORIGIN + 2] = z
        u = body[root, ORIGIN]
        v = body[root, ORIGIN + 1]
        w = body[root, ORIGIN + 2]
        arm = _carry(m, n, OWN_ARM)
        slide = 0.0
        a = _carry(base, n, AXIS)
        if kind == SPHERICAL:
            for k in range(3):
                _set_turn(column[k], (m[0, k], m[1, k], m[2, k]), x - u, y - v, z - w)
        elif kind >= REVOLUTE:
            _set_turn(column[0], a, x - u, y - v, z - w)
            if kind == UNIVERSAL:
                _set_turn(column[1], _carry(m, n, OWN_AXIS), x - u, y - v, z - w)
        if kind == PRISMATIC or kind == CYLINDRICAL:  # noqa: SIM109 (a tuple costs a comparison of tuples)
            last = tree.index[b, COUNT] - 1
            slide = q[tree.index[b, FIRST_Q] + last]
            for k in range(3):
                column[last, AXIS_OF + k] = 0.0
            column[last, AXIS_OF + 3] = a[0]
            column[last, AXIS_OF + 4] = a[1]
            column[last, AXIS_OF + 5] = a[2]
        x += slide * a[0] - arm[0]
        y += slide * a[1] - arm[1]
        z += slide * a[2] - arm[2]
        pose[7 * b - 4] = x
        pose[7 * b - 3] = y
        pose[7 * b - 2] = z
        body[b, REACH] = x - u
        body[b, REACH + 1] = y - v
        body[b, REACH + 2] = z - w
        body[b, ORIGIN] = u
        body[b, ORIGIN + 1] = v
        body[b, ORIGIN + 2] = w


@internal
def at_centre(body, b, part, out, d):
    """Fill out[d : d + 6] with the velocity of a centre of mass and w, of a motion in columns ``part`` on."""
    w = part_of(body[b], part)
    _set(out, d, add(part_of(body[b], part + 3), cross(w, part_of(body[b], REACH))), w)


@inlined
def _set(out, at, a, b):
    """Fill out[at : at + 6] with two vectors."""
    set_part(out, at, a[0], a[1], a[2])
    set_part(out, at + 3, b[0], b[1], b[2])


@internal
def move_tree(tree, work, rates):
    """Fill motions of bodies at rates (3 + nz,) in the world, and their accelerations while these stay."""
    body = work.body
    none = (0.0, 0.0, 0.0)
    for i in range(tree.order.shape[0]):
        b = tree.order[i]
        parent = tree.index[b, PARENT]
        first = tree.index[b, FIRST_Z] - 3
        count = tree.index[b, COUNT]
        w, v, x, y = none, none, none, none
        if parent > 0:
            m = body[parent]
            w, v, x, y = part_of(m, 0), part_of(m, 3), part_of(m, 6), part_of(m, 9)
        single = count - 3 if tree.index[b, KIND] <= SPHERICAL else count
        for k in range(first, first + single):
            s = work.column[k]
            u, t = scaled(part_of(s, 0), rates[3 + k]), scaled(part_of(s, 3), rates[3 + k])
            x, y = add(x, cross(w, u)), add(y, add(cross(w, t), cross(v, u)))
            w, v = add(w, u), add(v, t)
        if single < count:
            u, t = none, none
            for k in range(first + single, first + count):
                s = work.column[k]
                u, t = plus(u, rates[3 + k], part_of(s, 0)), plus(t, rates[3 + k], part_of(s, 3))
            x, y = add(x, cross(w, u)), add(y, add(cross(w, t), cross(v, u)))
            w, v = add(w, u), add(v, t)
        _set(body[b], VELOCITY, w, v)
        _set(body[b], MOTION, x, y)
        reach = part_of(body[b], REACH)
        centre = add(v, cross(w, reach))
        _set(work.rate, 6 * b - 3, centre, w)
        _set(work.bend, 6 * b - 3, add(add(y, cross(x, reach)), cross(w, centre)), x)
