"""Positions, rates and convective accelerations of all groups, and poses near those where two branches meet.

Each kind's equations stand in its file in mbsd/kinematics/groups/kinds/. The rates are solved for each column of B, and
once more for the convective accelerations, whose right-hand sides have the terms in omega^2 besides.

The motion passes a change point, where the two poses of a group meet, smoothly, yet near it a closed form loses digits:
with s the sine of the angle between the group's links and e the rounding, angles lose e / s, rates e / s^2 and
convective accelerations e / s^3. There poses and rates are those of twelve poses beside, whose coordinates lie ahead
and back along the motion:

    X(z) = sum W_i (X(z + x_i A z' / w) + X(z - x_i A z' / w)),   x = 1, 1.3, 1.6, 1.9, 2.2, 2.5,   A = 0.25 rad

with w the rate (rad/s) of the body that turns fastest. This holds for polynomials of degree 11. The same sum without
the outermost two tells the error. Where it is not small, A is halved.

The motion of the whole is no such polynomial where other links nearly close and keep their two poses apart. Then each
group is solved alone, in order: by its closed form where its two poses are apart, else by the same sum over poses
beside, in which the bodies that it stands on have turned about their instantaneous centres, and their rates with them.
Any smooth motion through the pose serves, for only what it is at the pose is asked for; this one passes the change
point of links whose pivots rest on ground or on one body. Where it fails, too, the closed form stands.
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.compiling.jit import inlined, internal, lazy
from mbsd.dynamics.independent.block import embed_block, with_body
from mbsd.equations.laws import evaluate_laws
from mbsd.kinematics.groups import carried
from mbsd.kinematics.groups.blocks import BLOCK, TRAIN
from mbsd.kinematics.groups.cases import FLOOR, PerCoordinate, angle_of
from mbsd.kinematics.groups.groups import FIRST, K1, K2, KIND, LAW, SECOND
from mbsd.kinematics.groups.kinds.train import embed_train
from mbsd.kinematics.groups.solve import solve_group


@inlined
def embed_groups(dyn, scratch):
    """Fill ``scratch.body`` and ``rate`` from coordinate and drive; returns SOLVED, or DOUBTED where a pose is unclear.

    With a single coordinate its inertia and M (g - c) are summed on the way, while numbers are at hand.
    """
    group = dyn.group
    body = scratch.body
    rate = scratch.rate
    sums = scratch.sums
    single = rate.shape[1] == 6
    total = 0.0
    push = 0.0
    case = PerCoordinate(group, dyn.number, body, rate, scratch.base, scratch.coordinate, scratch.drive)
    for e in range(group.shape[0]):
        bodies = group[e]
        if bodies[KIND] == BLOCK:
            status = embed_block(dyn, scratch, bodies[LAW])
        elif bodies[KIND] == TRAIN:
            status = embed_train(bodies, dyn.number[e], body, rate, scratch.base, scratch.coordinate)
        else:
            status = solve_group(case, e)
        if status != carried.SOLVED:
            return status
        if single and bodies[KIND] == BLOCK:
            total += sums[0]
            push += sums[1]
        elif single:
            total, push = with_body(body, rate, dyn.gravity, bodies[FIRST], total, push)
            if bodies[SECOND] >= 0:
                total, push = with_body(body, rate, dyn.gravity, bodies[SECOND], total, push)
    sums[0] = total
    sums[1] = push
    return carried.SOLVED


def _weights(x: np.ndarray) -> np.ndarray:
    """Weights of one value of each pair x_i, -x_i: the polynomial through all of them, at zero."""
    square = x**2
    return np.array([0.5 * np.prod(np.delete(square, i) / np.delete(square - square[i], i)) for i in range(len(x))])


APART = np.array([1.0, 1.3, 1.6, 1.9, 2.2, 2.5])
WEIGHTS = _weights(APART)
ERROR_WEIGHTS = WEIGHTS - np.append(_weights(APART[:-1]), 0.0)
WAY, HALVINGS = 0.25, 3
"""A (rad), and how often it is tried."""
CLOSE, CLOSE_RATE = 1e-10, 1e-9
"""Errors allowed of cosines and sines, and of rates of turning, as a part of w."""
KEPT = carried.SIN + 1
"""Columns of EmbeddingScratch.body that are continued."""
CLOSEST = 1e-8
"""Squared sine above which the closed form stands where no poses beside are clear: there the motion itself bends as
sharply as the pose is close, so that rounding stays a small part of its rates."""
SLIGHT = 1e-8
"""Turn (rad) below which a body moves straight on."""


@internal
def _copy(to, row, count):
    """Copy the first ``count`` numbers of a row."""
    for c in range(count):
        to[c] = row[c]


@internal
def _add(to, weight, row, count):
    """Add ``weight`` times the first ``count`` numbers of a row."""
    for c in range(count):
        to[c] += weight * row[c]


@internal
def _clear(joined_body, joined_rate, b):
    """Begin the sums of body b."""
    for part in range(2):
        for c in range(KEPT):
            joined_body[part, b, c] = 0.0
        for c in range(joined_rate.shape[2]):
            joined_rate[part, b, c] = 0.0


@internal
def _sum(scratch, b, i):
    """Add pair i of poses beside to the sums of body b."""
    columns = scratch.rate.shape[1]
    _add(scratch.joined_body[0, b], WEIGHTS[i], scratch.body[b], KEPT)
    _add(scratch.joined_body[1, b], ERROR_WEIGHTS[i], scratch.body[b], KEPT)
    _add(scratch.joined_rate[0, b], WEIGHTS[i], scratch.rate[b], columns)
    _add(scratch.joined_rate[1, b], ERROR_WEIGHTS[i], scratch.rate[b], columns)


@internal
def _velocity(rate, coordinate, b, c):
    """Return rate ``c`` of body b along the motion: x, y (m) or angle (rad), by the first unit of the way."""
    columns = coordinate.shape[0] - 1
    total = 0.0
    for j in range(columns):
        total += rate[b, 3 * j + c] * (coordinate[j, carried.SPEED] if columns > 1 else 1.0)
    return total


@internal
def _joined(dyn, scratch, t, way, fastest):
    """Fill joined_body and joined_rate from poses beside; returns whether all are clear and agree."""
    body = scratch.body
    coordinate = scratch.coordinate
    drive = scratch.drive
    joined_body = scratch.joined_body
    joined_rate = scratch.joined_rate
    columns = coordinate.shape[0] - 1
    for b in range(1, body.shape[0]):
        _clear(joined_body, joined_rate, b)
    for i in range(APART.shape[0]):
        for side in range(2):
            ahead = (1.0 - 2.0 * side) * APART[i] * way / fastest
            for j in range(columns):
                coordinate[j, carried.VALUE] += ahead * (coordinate[j, carried.SPEED] if columns > 1 else 1.0)
            if drive.shape[0] > 1:
                evaluate_laws(dyn.laws, drive.shape[0], t + ahead, drive)
            status = embed_groups(dyn, scratch)
            for j in range(columns):
                coordinate[j, carried.VALUE] -= ahead * (coordinate[j, carried.SPEED] if columns > 1 else 1.0)
            if status != carried.SOLVED:
                return False
            for b in range(1, body.shape[0]):
                _sum(scratch, b, i)
    for b in range(1, body.shape[0]):
        if not abs(joined_body[1, b, carried.COS]) + abs(joined_body[1, b, carried.SIN]) <= CLOSE:
            return False
        if not abs(_velocity(joined_rate[1], coordinate, b, 2)) <= CLOSE_RATE * fastest:
            return False
    return True


@internal
def _turn_about_centre(scratch, b, ahead):
    """Turn body b and its rates about its instantaneous centre, ``ahead`` along the motion."""
    body = scratch.body
    rate = scratch.rate[b]
    vx = _velocity(scratch.rate, scratch.coordinate, b, 0)
    vy = _velocity(scratch.rate, scratch.coordinate, b, 1)
    omega = _velocity(scratch.rate, scratch.coordinate, b, 2)
    c = math.cos(omega * ahead)
    s = math.sin(omega * ahead)
    along = ahead
    aside = 0.0
    if abs(omega * ahead) > SLIGHT:
        along = s / omega
        aside = (1.0 - c) / omega
    body[b, carried.X] += along * vx - aside * vy
    body[b, carried.Y] += along * vy + aside * vx
    cos = body[b, carried.COS]
    body[b, carried.COS] = c * cos - s * body[b, carried.SIN]
    body[b, carried.SIN] = s * cos + c * body[b, carried.SIN]
    for k in range(0, rate.shape[0], 3):
        x = rate[k]
        rate[k] = c * x - s * rate[k + 1]
        rate[k + 1] = s * x + c * rate[k + 1]


@internal
def _solve(dyn, scratch, e):
    """Solve group e, of any kind but a block, by its closed form; returns SOLVED or DOUBTED."""
    if dyn.group[e, KIND] == TRAIN:
        return embed_train(dyn.group[e], dyn.number[e], scratch.body, scratch.rate, scratch.base, scratch.coordinate)
    case = PerCoordinate(
        dyn.group, dyn.number, scratch.body, scratch.rate, scratch.base, scratch.coordinate, scratch.drive
    )
    return solve_group(case, e)


@internal
def _joined_alone(dyn, scratch, e, way):
    """Fill joined_body and joined_rate of the bodies of group e; returns whether all poses are clear and agree.

    ``way``: of the outermost poses over 2.5, in units of the coordinate, or s of several.
    """
    bodies = dyn.group[e]
    body = scratch.body
    coordinate = scratch.coordinate
    joined_body = scratch.joined_body
    joined_rate = scratch.joined_rate
    columns = coordinate.shape[0] - 1
    for b in bodies[: SECOND + 1]:
        if b > 0:
            _clear(joined_body, joined_rate, b)
    for i in range(APART.shape[0]):
        for side in range(2):
            ahead = (1.0 - 2.0 * side) * APART[i] * way
            for j in range(columns):
                coordinate[j, carried.VALUE] += ahead * (coordinate[j, carried.SPEED] if columns > 1 else 1.0)
            for k in range(K1, K2 + 1):
                if bodies[k] > 0 and (k == K1 or bodies[k] != bodies[K1]):
                    _copy(joined_body[2, bodies[k]], body[bodies[k]], KEPT)
                    _copy(joined_rate[2, bodies[k]], scratch.rate[bodies[k]], scratch.rate.shape[1])
                    _turn_about_centre(scratch, bodies[k], ahead)
            status = _solve(dyn, scratch, e)
            for b in bodies[K1 : K2 + 1]:
                if b > 0:
                    _copy(body[b], joined_body[2, b], KEPT)
                    _copy(scratch.rate[b], joined_rate[2, b], scratch.rate.shape[1])
            for j in range(columns):
                coordinate[j, carried.VALUE] -= ahead * (coordinate[j, carried.SPEED] if columns > 1 else 1.0)
            if status != carried.SOLVED:
                return False
            for b in bodies[: SECOND + 1]:
                if b > 0:
                    _sum(scratch, b, i)
    for b in bodies[: SECOND + 1]:
        if b > 0:
            if not abs(joined_body[1, b, carried.COS]) + abs(joined_body[1, b, carried.SIN]) <= CLOSE:
                return False
            if not abs(_velocity(joined_rate[1], coordinate, b, 2)) * way <= CLOSE_RATE:
                return False
    return True


@internal
def _solve_alone(dyn, scratch, e, usual):
    """Solve group e, from poses beside if its squared sine is below ``usual``; returns SOLVED or DOUBTED."""
    status = _solve(dyn, scratch, e)
    sine = dyn.number[e, carried.SINE]
    if not sine < usual or (status != carried.SOLVED and not abs(sine) <= FLOOR):
        return status
    bodies = dyn.group[e]
    base = scratch.base
    coordinate = scratch.coordinate
    columns = coordinate.shape[0] - 1
    _copy(scratch.joined_rate[2, 0], coordinate[:, carried.BASE], columns)
    for b in bodies[: SECOND + 1]:
        if b > 0:
            _copy(scratch.joined_rate[2, b], base[b], carried.TURNS + columns)
            if status == carried.SOLVED:  # poses beside are predicted from this very pose
                base[b, carried.THETA] = angle_of(scratch.body, base, coordinate, b)
                base[b, carried.BEND] = 0.0
                for j in range(columns):
                    base[b, carried.TURNS + j] = scratch.rate[b, 3 * j + 2]
    if status == carried.SOLVED:
        _copy(coordinate[:, carried.BASE], coordinate[:, carried.VALUE], columns)
    fastest = 0.0
    for b in bodies[: K2 + 1]:
        if b > 0:
            turning = 0.0
            for j in range(columns):
                turning += base[b, carried.TURNS + j] * (coordinate[j, carried.SPEED] if columns > 1 else 1.0)
            fastest = max(fastest, abs(turning))
    dyn.number[e, carried.AVOID] = usual
    joined = False
    way = WAY
    for _ in range(HALVINGS):
        joined = fastest > 0.0 and _joined_alone(dyn, scratch, e, way / fastest)
        if joined:
            break
        way *= 0.5
    dyn.number[e, carried.AVOID] = FLOOR
    _copy(coordinate[:, carried.BASE], scratch.joined_rate[2, 0], columns)
    for b in bodies[: SECOND + 1]:
        if b > 0:
            _copy(base[b], scratch.joined_rate[2, b], carried.TURNS + columns)
    if not joined:
        dyn.number[e, carried.AVOID] = CLOSEST
        status = _solve(dyn, scratch, e)
        dyn.number[e, carried.AVOID] = FLOOR
        return status
    for b in bodies[: SECOND + 1]:
        if b > 0:
            _copy(scratch.body[b], scratch.joined_body[0, b], KEPT)
            _copy(scratch.rate[b], scratch.joined_rate[0, b], scratch.rate.shape[1])
            turning = 0.0
            for j in range(columns):
                turning += scratch.rate[b, 3 * j + 2] * coordinate[j, carried.SPEED]
            scratch.body[b, carried.OMEGA] = turning
    dyn.number[e, carried.SINE] = 0.0  # not that of the last pose beside, so that the next pose asks for its branch
    return carried.SOLVED


@lazy(int)
def bridge(dyn, scratch, t):
    """Fill body, rate and sums near an unclear pose at t (s); returns SOLVED or DOUBTED.

    Coordinates and drive are those of the pose, and stay.
    """
    body = scratch.body
    rate = scratch.rate
    base = scratch.base
    coordinate = scratch.coordinate
    columns = coordinate.shape[0] - 1
    fastest = 0.0
    for b in range(1, base.shape[0]):
        turning = 0.0
        for j in range(columns):
            turning += base[b, carried.TURNS + j] * (coordinate[j, carried.SPEED] if columns > 1 else 1.0)
        fastest = max(fastest, abs(turning))
    joined = False
    way = WAY
    if fastest > 0.0:
        for _ in range(HALVINGS):
            joined = _joined(dyn, scratch, t, way, fastest)
            if joined:
                break
            way *= 0.5
        if scratch.drive.shape[0] > 1:
            evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    number = dyn.number
    if joined:
        for e in range(number.shape[0]):
            number[e, carried.SINE] = 0.0
    else:
        for e in range(number.shape[0]):
            usual = number[e, carried.AVOID]
            number[e, carried.AVOID] = FLOOR
            status = _solve_alone(dyn, scratch, e, usual)
            number[e, carried.AVOID] = usual
            if status != carried.SOLVED:
                return status
    total = 0.0
    push = 0.0
    single = rate.shape[1] == 6
    for b in range(1, body.shape[0]):
        if joined:
            _copy(body[b], scratch.joined_body[0, b], KEPT)
            _copy(rate[b], scratch.joined_rate[0, b], rate.shape[1])
        if single:
            total, push = with_body(body, rate, dyn.gravity, b, total, push)
    scratch.sums[0] = total
    scratch.sums[1] = push
    return carried.SOLVED
