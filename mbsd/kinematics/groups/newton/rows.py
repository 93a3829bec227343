"""Places, columns of unknowns and equations of one block; tables as in groups/blocks.py.

Equations are those of mbsd/equations/relative/equation.py with the bodies of the block alone unknown.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import merged
from mbsd.equations.relative import equation
from mbsd.equations.system import LAST, ZERO
from mbsd.kinematics.groups import blocks
from mbsd.kinematics.groups.carried import carried, follow, hang


@merged
def read_unknowns(block, q, turn, u):
    """Read the unknowns u (n,) of the block's bodies from the pose q (3 nb,), and turn the bodies."""
    tree = block.tree
    count = block.head[blocks.BODIES]
    for e in range(count):
        body = tree[e, blocks.BODY]
        turn[body, 0] = math.cos(q[3 * body + 2])
        turn[body, 1] = math.sin(q[3 * body + 2])
    for e in range(count):
        body = tree[e, blocks.BODY]
        parent = tree[e, blocks.PARENT]
        c = tree[e, blocks.UNKNOWN]
        if tree[e, blocks.HANGS] == blocks.PIN:
            u[c] = q[3 * body + 2]
        elif tree[e, blocks.HANGS] == blocks.FREE:
            for i in range(3):
                u[c + i] = q[3 * body + i]
        elif tree[e, blocks.HANGS] == blocks.SLIDE:
            n = block.frame[e]
            x = q[3 * body] - q[3 * parent] + turn[body, 0] * n[5] - turn[body, 1] * n[6]
            y = q[3 * body + 1] - q[3 * parent + 1] + turn[body, 1] * n[5] + turn[body, 0] * n[6]
            ex = turn[parent, 0] * x + turn[parent, 1] * y - n[0]
            ey = turn[parent, 0] * y - turn[parent, 1] * x - n[1]
            u[c] = n[2] * ex + n[3] * ey


@merged
def slid(q, v, a, turn, parent, n, way, speed, gain, point):
    """Set the point of a slide on ``parent``, with rates: S'' = k'' + 2 omega s' e_perp + s'' e."""
    ex = turn[parent, 0] * n[2] - turn[parent, 1] * n[3]
    ey = turn[parent, 1] * n[2] + turn[parent, 0] * n[3]
    carried(q, v, a, turn, parent, n[0] + way * n[2], n[1] + way * n[3], point)
    spin = 2.0 * v[3 * parent + 2] * speed
    point[2] += speed * ex
    point[3] += speed * ey
    point[4] += gain * ex - spin * ey
    point[5] += gain * ey + spin * ex


@merged
def move(block, u, turned, motion, point):
    """Place the block's bodies by the unknowns u (3, n) with rates; ``turned``: pins' are in ``turn``."""
    tree = block.tree
    frame = block.frame
    q = motion.q
    v = motion.v
    a = motion.a
    turn = motion.turn
    for e in range(block.head[blocks.BODIES]):
        body = tree[e, blocks.BODY]
        parent = tree[e, blocks.PARENT]
        c = tree[e, blocks.UNKNOWN]
        n = frame[e]
        hangs = tree[e, blocks.HANGS]
        if hangs == blocks.FREE:
            for i in range(3):
                q[3 * body + i] = u[0, c + i]
                v[3 * body + i] = u[1, c + i]
                a[3 * body + i] = u[2, c + i]
            turn[body, 0] = math.cos(q[3 * body + 2])
            turn[body, 1] = math.sin(q[3 * body + 2])
        elif hangs == blocks.SLIDE:
            follow(q, v, a, turn, body, parent, n[4])
            slid(q, v, a, turn, parent, n, u[0, c], u[1, c], u[2, c], point[0])
            hang(q, v, a, turn, body, point[0], n[5], n[6])
        else:
            if hangs == blocks.PIN:
                q[3 * body + 2] = u[0, c]
                v[3 * body + 2] = u[1, c]
                a[3 * body + 2] = u[2, c]
                if not turned:
                    turn[body, 0] = math.cos(u[0, c])
                    turn[body, 1] = math.sin(u[0, c])
            else:
                follow(q, v, a, turn, body, parent, n[4])
            carried(q, v, a, turn, parent, n[0], n[1], point[0])
            hang(q, v, a, turn, body, point[0], n[5], n[6])


@merged
def fill_columns(block, q, turn, columns):
    """Fill columns (bodies, unknowns, 3) with rates of each body for a unit rate of each unknown."""
    tree = block.tree
    frame = block.frame
    unknowns = block.head[blocks.EQUATIONS]
    for e in range(block.head[blocks.BODIES]):
        body = tree[e, blocks.BODY]
        parent = tree[e, blocks.PARENT]
        place = tree[e, blocks.PARENT_PLACE]
        c = tree[e, blocks.UNKNOWN]
        hangs = tree[e, blocks.HANGS]
        n = frame[e]
        own = 3 * unknowns * e
        for j in range(3 * unknowns):
            columns[own + j] = 0.0
        if hangs == blocks.FREE:
            for i in range(3):
                columns[own + 3 * (c + i) + i] = 1.0
            continue
        sx = turn[body, 0] * n[5] - turn[body, 1] * n[6]
        sy = turn[body, 1] * n[5] + turn[body, 0] * n[6]
        if place >= 0:
            rx = q[3 * body] + sx - q[3 * parent]
            ry = q[3 * body + 1] + sy - q[3 * parent + 1]
            of_parent = 3 * unknowns * place
            for j in range(unknowns):
                omega = columns[of_parent + 3 * j + 2]
                turning = omega if hangs != blocks.PIN else 0.0
                columns[own + 3 * j] = columns[of_parent + 3 * j] - omega * ry + turning * sy
                columns[own + 3 * j + 1] = columns[of_parent + 3 * j + 1] + omega * rx - turning * sx
                columns[own + 3 * j + 2] = turning
        if hangs == blocks.PIN:
            columns[own + 3 * c] += sy
            columns[own + 3 * c + 1] -= sx
            columns[own + 3 * c + 2] += 1.0
        elif hangs == blocks.SLIDE:
            columns[own + 3 * c] += turn[parent, 0] * n[2] - turn[parent, 1] * n[3]
            columns[own + 3 * c + 1] += turn[parent, 1] * n[2] + turn[parent, 0] * n[3]


@merged
def evaluate_row(row, n, q, turn, numbers, relative, out, jac):
    """Return F of an equation; fill out (10,) with F and its derivatives, jac (6,) with its row."""
    i = row[blocks.BODY_I]
    j = row[blocks.BODY_J]
    six = turn[i, 0] * n[0] - turn[i, 1] * n[1]
    siy = turn[i, 1] * n[0] + turn[i, 0] * n[1]
    ux = turn[i, 0] * n[2] - turn[i, 1] * n[3]
    uy = turn[i, 1] * n[2] + turn[i, 0] * n[3]
    sjx = turn[j, 0] * n[4] - turn[j, 1] * n[5]
    sjy = turn[j, 1] * n[4] + turn[j, 0] * n[5]
    dx = q[3 * j] + sjx - q[3 * i] - six
    dy = q[3 * j + 1] + sjy - q[3 * i + 1] - siy
    x = ux * dx + uy * dy
    y = ux * dy - uy * dx
    angle = q[3 * j + 2] - q[3 * i + 2]
    kind = row[blocks.EQUATION]
    if kind == blocks.SPECIAL:
        relative[equation.X] = x
        relative[equation.Y] = y
        relative[equation.A] = angle + numbers[row[blocks.AT]]
        relative[equation.TURN] = q[3 * row[blocks.ARM] + 2] - q[3 * i + 2]
        relative[ZERO] = 0.0
        relative[LAST] = math.nan
        equation.evaluate(row[blocks.ADDRESS], numbers[row[blocks.AT] :], relative, out)
    else:
        equation.clear(out)
        if kind == blocks.ALONG:
            out[equation.F] = x - n[6]
            out[equation.FX] = 1.0
        elif kind == blocks.ACROSS:
            out[equation.F] = y - n[6]
            out[equation.FY] = 1.0
        elif kind == blocks.TURNED:
            out[equation.F] = angle - n[6]
            out[equation.FA] = 1.0
        else:
            length = math.sqrt(x * x + y * y)
            cube = length * length * length
            out[equation.F] = length - n[6]
            out[equation.FX] = x / length
            out[equation.FY] = y / length
            out[equation.FXX] = y * y / cube
            out[equation.FXY] = -x * y / cube
            out[equation.FYY] = x * x / cube
    equation.fill_row(out, ux, uy, x, y, six, siy, sjx, sjy, jac)
    return out[equation.F]


@merged
def bend_of(row, n, q, v, turn, out):
    """Return gamma of one equation without f'', after evaluate_row at the same pose."""
    i = row[blocks.BODY_I]
    j = row[blocks.BODY_J]
    omega = v[3 * i + 2]
    other = v[3 * j + 2]
    six = turn[i, 0] * n[0] - turn[i, 1] * n[1]
    siy = turn[i, 1] * n[0] + turn[i, 0] * n[1]
    ux = turn[i, 0] * n[2] - turn[i, 1] * n[3]
    uy = turn[i, 1] * n[2] + turn[i, 0] * n[3]
    sjx = turn[j, 0] * n[4] - turn[j, 1] * n[5]
    sjy = turn[j, 1] * n[4] + turn[j, 0] * n[5]
    dx = q[3 * j] + sjx - q[3 * i] - six
    dy = q[3 * j + 1] + sjy - q[3 * i + 1] - siy
    vx = v[3 * j] - other * sjy - v[3 * i] + omega * siy
    vy = v[3 * j + 1] + other * sjx - v[3 * i + 1] - omega * six
    cx = omega * omega * six - other * other * sjx
    cy = omega * omega * siy - other * other * sjy
    x = ux * dx + uy * dy
    y = ux * dy - uy * dx
    return equation.gamma_of(out, ux, uy, x, y, vx, vy, cx, cy, omega, other - omega)
