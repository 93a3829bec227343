"""Positions, rates and convective accelerations of all groups, and poses near those where two branches meet.

Each kind's equations stand in its file in mbsd/kinematics/groups/kinds/. The rates are solved for each column of B, and
once more for the convective accelerations, whose right-hand sides have the terms in omega^2 besides.

The motion passes a change point, where the two poses of a group meet, smoothly, yet near it a closed form loses digits:
with s the sine of the angle between the group's links and e the rounding, angles lose e / s, rates e / s^2 and
convective accelerations e / s^3. There poses and rates are those of twelve poses beside, whose coordinates lie ahead
and back along the motion:

    X(z) = sum W_i (X(z + x_i A z' / w) + X(z - x_i A z' / w)),   x = 1, 1.3, 1.6, 1.9, 2.2, 2.5,   A = 0.25 rad

with w the rate (rad/s) of the body that turns fastest. This holds for polynomials of degree 11. The same sum without
the outermost two tells the error. Where it is not small, as where links that nearly close keep the two poses apart, A
is halved; then the closed form itself stands.
"""

from __future__ import annotations

import numpy as np

from mbsd.compiling.jit import inlined, internal, lazy
from mbsd.dynamics.independent.block import embed_block, with_body
from mbsd.equations.laws import evaluate_laws
from mbsd.kinematics.groups.blocks import BLOCK, TRAIN
from mbsd.kinematics.groups.carried import AVOID, COS, SIN, SOLVED, SPEED, TURNS, VALUE
from mbsd.kinematics.groups.cases import FLOOR, PerCoordinate
from mbsd.kinematics.groups.groups import FIRST, KIND, LAW, SECOND
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
        if status != SOLVED:
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
    return SOLVED


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
KEPT = SIN + 1
"""Columns of EmbeddingScratch.body that are continued."""


@internal
def _joined(dyn, scratch, t, way, fastest):
    """Fill joined_body and joined_rate from poses beside; returns whether all are clear and agree."""
    body = scratch.body
    rate = scratch.rate
    coordinate = scratch.coordinate
    drive = scratch.drive
    joined_body = scratch.joined_body
    joined_rate = scratch.joined_rate
    columns = coordinate.shape[0] - 1
    for part in range(2):
        for b in range(1, body.shape[0]):
            for c in range(KEPT):
                joined_body[part, b, c] = 0.0
            for c in range(rate.shape[1]):
                joined_rate[part, b, c] = 0.0
    for i in range(APART.shape[0]):
        for side in range(2):
            ahead = (1.0 - 2.0 * side) * APART[i] * way / fastest
            for j in range(columns):
                coordinate[j, VALUE] += ahead * (coordinate[j, SPEED] if columns > 1 else 1.0)
            if drive.shape[0] > 1:
                evaluate_laws(dyn.laws, drive.shape[0], t + ahead, drive)
            status = embed_groups(dyn, scratch)
            for j in range(columns):
                coordinate[j, VALUE] -= ahead * (coordinate[j, SPEED] if columns > 1 else 1.0)
            if status != SOLVED:
                return False
            for b in range(1, body.shape[0]):
                for c in range(KEPT):
                    joined_body[0, b, c] += WEIGHTS[i] * body[b, c]
                    joined_body[1, b, c] += ERROR_WEIGHTS[i] * body[b, c]
                for c in range(rate.shape[1]):
                    joined_rate[0, b, c] += WEIGHTS[i] * rate[b, c]
                    joined_rate[1, b, c] += ERROR_WEIGHTS[i] * rate[b, c]
    for b in range(1, body.shape[0]):
        if not abs(joined_body[1, b, COS]) + abs(joined_body[1, b, SIN]) <= CLOSE:
            return False
        turning = 0.0
        for j in range(columns):
            turning += joined_rate[1, b, 3 * j + 2] * (coordinate[j, SPEED] if columns > 1 else 1.0)
        if not abs(turning) <= CLOSE_RATE * fastest:
            return False
    return True


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
            turning += base[b, TURNS + j] * (coordinate[j, SPEED] if columns > 1 else 1.0)
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
    if not joined:
        number = dyn.number
        usual = 0.0
        for e in range(number.shape[0]):
            usual = number[e, AVOID]
            number[e, AVOID] = FLOOR
        status = embed_groups(dyn, scratch)
        for e in range(number.shape[0]):
            number[e, AVOID] = usual
        return status
    total = 0.0
    push = 0.0
    single = rate.shape[1] == 6
    for b in range(1, body.shape[0]):
        for c in range(KEPT):
            body[b, c] = scratch.joined_body[0, b, c]
        for c in range(rate.shape[1]):
            rate[b, c] = scratch.joined_rate[0, b, c]
        if single:
            total, push = with_body(body, rate, dyn.gravity, b, total, push)
    scratch.sums[0] = total
    scratch.sums[1] = push
    return SOLVED
