"""Contact of outlines by penalty: runs of body j's outline that are in body i are pushed out.

The pairs are those of mbsd/equations/relative/outline_features.py, all runs of one outline here; the law of each is
that of contact.py with depth d = -gap. A run that is in a concave corner is pushed by both its sides. The deepest pair
switches: within a step in which it touches, it goes on smoothly where it does not.
"""

from __future__ import annotations

import math

from mbsd.equations.interactions import law
from mbsd.equations.relative import outline_features as features

STIFFNESS, EXPONENT, DAMPING, FRICTION, SLIP_SPEED, AROUND_X, AROUND_Y, AROUND, OTHER_X, OTHER_Y, OTHER = range(11)
"""Own numbers after the tables: those of the law, and circles around the outlines of bodies i and j."""
SWITCHES = True


@law.interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above, after those of outline_features.py."""
    out[law.FX] = 0.0
    out[law.FY] = 0.0
    out[law.TORQUE] = 0.0
    own = features.feature_at(numbers, int(numbers[features.FEATURES]))
    away = _apart(numbers, state, own, own + OTHER_X)
    if away > 0.0:
        law.note(out, -away, 0.0, numbers[own + EXPONENT])
        return
    deepest = -numbers[features.NOWHERE]
    rate = 0.0
    place = -1
    place_run = -1
    place_end = 0
    for run in range(int(numbers[features.RUNS])):
        away = _apart(numbers, state, own, features.run_at(numbers, run) + features.RUN_X)
        if away > 0.0:
            deepest = max(deepest, -away)
            continue
        skip_run = -1
        skip = -1
        foot = 0.0
        within = numbers[features.NOWHERE]
        for _ in range(2):
            _, feature, gap = features.search(numbers, state, run, run + 1, skip_run, skip, foot, within)
            if feature < 0:
                break
            end = int(state[features.USED_END])
            gap = features.stand(numbers, state, run, features.feature_at(numbers, feature), end)
            foot = state[features.FOOT]
            if features.touches(numbers, state, feature):
                pushes = gap < 0.0 and state[law.SIDE] >= 0.0
                speed = _push(numbers, state, out, own, feature, -gap, pushes)
                if -gap > deepest:
                    deepest = -gap
                    rate = speed
                    place = feature
                    place_run = run
                    place_end = end
                if gap >= 0.0:
                    break
                within = -gap  # a second place is no deeper than the first
            if numbers[features.SECOND] == 0.0:
                break
            skip_run = run
            skip = feature
    if state[law.SIDE] > 0.0 and deepest <= 0.0 and place >= 0:
        gap = features.stand(numbers, state, place_run, features.feature_at(numbers, place), place_end)
        _push(numbers, state, out, own, place, -gap, True)
    law.note(out, deepest, rate, numbers[own + EXPONENT])


@law.internal
def _apart(numbers, state, own, circle):
    """Return how far a circle of body j, from column ``circle`` on, is from that around outline i (m)."""
    c = math.cos(state[law.A])
    s = math.sin(state[law.A])
    x = state[law.X] + c * numbers[circle] - s * numbers[circle + 1] - numbers[own + AROUND_X]
    y = state[law.Y] + s * numbers[circle] + c * numbers[circle + 1] - numbers[own + AROUND_Y]
    return math.sqrt(x * x + y * y) - numbers[circle + 2] - numbers[own + AROUND]


@law.internal
def _push(numbers, state, out, own, feature, depth, pushes):
    """Add the force of the pair in the scratch if it ``pushes``; returns the rate of its depth (m/s)."""
    f = features.feature_at(numbers, feature)
    if numbers[f + features.KIND] == features.LINE:
        nx = numbers[f + features.T0Y]
        ny = -numbers[f + features.T0X]
    else:
        length = math.sqrt(state[features.WX] ** 2 + state[features.WY] ** 2)
        if length == 0.0:
            return 0.0
        nx = numbers[f + features.KIND] * state[features.WX] / length
        ny = numbers[f + features.KIND] * state[features.WY] / length
    ax = state[features.QX] - (state[features.CR] - depth) * nx
    ay = state[features.QY] - (state[features.CR] - depth) * ny
    vx = state[law.VX] - state[law.OMEGA] * ay
    vy = state[law.VY] + state[law.OMEGA] * ax
    rate = -(nx * vx + ny * vy)
    if not pushes:
        return rate
    normal = law.normal_force(
        state, depth, rate, numbers[own + STIFFNESS], numbers[own + EXPONENT], numbers[own + DAMPING], 0.0, 1.0
    )
    along = 0.0
    if numbers[own + FRICTION] > 0.0:
        slip = ny * vx - nx * vy
        along = -numbers[own + FRICTION] * math.tanh(slip / numbers[own + SLIP_SPEED]) * normal
    fx = normal * nx + along * ny
    fy = normal * ny - along * nx
    out[law.FX] += fx
    out[law.FY] += fy
    out[law.TORQUE] += ax * fy - ay * fx
    return rate
