"""Contact of outlines by penalty: each run of body j's outline that is in that of body i is pushed out.

The pairs are those of mbsd/equations/relative/outline_features.py, all runs of one outline here; the law of each is
that of contact.py with depth d = -gap. A run that is in a concave corner is pushed by both its sides.
"""

from __future__ import annotations

import math

from mbsd.equations.interactions import law
from mbsd.equations.relative import outline_features as features

STIFFNESS, EXPONENT, DAMPING, FRICTION, SLIP_SPEED, AROUND_X, AROUND_Y, AROUND = range(8)
"""Own numbers after the tables: those of the law, and a circle around the outline of body i."""
SWITCHES = True


@law.interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above, after those of outline_features.py."""
    out[law.FX] = 0.0
    out[law.FY] = 0.0
    out[law.TORQUE] = 0.0
    own = features.feature_at(numbers, int(numbers[features.FEATURES]))
    c = math.cos(state[law.A])
    s = math.sin(state[law.A])
    deepest = -numbers[features.NOWHERE]
    rate = 0.0
    for run in range(int(numbers[features.RUNS])):
        row = features.run_at(numbers, run)
        x = state[law.X] + c * numbers[row + features.RUN_X] - s * numbers[row + features.RUN_Y]
        y = state[law.Y] + s * numbers[row + features.RUN_X] + c * numbers[row + features.RUN_Y]
        away = math.sqrt((x - numbers[own + AROUND_X]) ** 2 + (y - numbers[own + AROUND_Y]) ** 2)
        away -= numbers[row + features.RUN_REACH] + numbers[own + AROUND]
        if away > 0.0 and (state[law.SIDE] <= 0.0 or away > numbers[own + AROUND]):
            deepest = max(deepest, -away)
            continue
        skip_run = -1
        skip = -1
        foot = 0.0
        for _ in range(2):
            _, feature, gap = features.search(numbers, state, run, run + 1, skip_run, skip, foot)
            if feature < 0:
                break
            end = int(state[features.USED_END])
            gap = features.stand(numbers, state, run, features.feature_at(numbers, feature), end)
            foot = state[features.FOOT]
            if features.touches(numbers, state, feature):
                speed = _push(numbers, state, out, own, feature, -gap)
                if -gap > deepest:
                    deepest = -gap
                    rate = speed
            if numbers[features.SECOND] == 0.0:
                break
            skip_run = run
            skip = feature
    law.note(out, deepest, rate, numbers[own + EXPONENT])


@law.internal
def _push(numbers, state, out, own, feature, depth):
    """Add the force of the pair in the scratch; returns the rate of its depth (m/s)."""
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
    if not law.touches(state, depth):
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
