"""Journal in a bearing with clearance; the law is in forces/clearance_joint.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions.law import (
    APPROACH,
    FX,
    FY,
    OMEGA,
    OWN,
    POWER,
    SIDE,
    SPEED,
    SWITCH,
    TORQUE,
    VX,
    VY,
    X,
    Y,
    interaction,
)

JOURNAL, CLEARANCE, STIFFNESS, EXPONENT, DAMPING, FRICTION, CREEP, SLIDE, LOSS, LEAST_APPROACH = range(10)
SWITCHES = True


@interaction
def force(numbers, state, out):
    """Own numbers by the names above."""
    out[FX] = 0.0
    out[FY] = 0.0
    out[TORQUE] = 0.0
    eccentricity = math.sqrt(state[X] * state[X] + state[Y] * state[Y])
    depth = eccentricity - numbers[OWN + CLEARANCE]
    power = numbers[OWN + EXPONENT]
    nx = 0.0
    ny = 0.0
    if eccentricity > 0.0:
        nx = state[X] / eccentricity
        ny = state[Y] / eccentricity
    rate = nx * state[VX] + ny * state[VY]
    out[SWITCH] = depth
    out[SPEED] = rate
    out[POWER] = power if power != math.floor(power) else 0.0
    if state[SIDE] > 0.0 or (state[SIDE] == 0.0 and depth > 0.0):
        damping = numbers[OWN + DAMPING]
        approach = state[APPROACH]
        if numbers[OWN + LOSS] > 0.0 and approach == approach:  # no number: it began to move within the bearing's wall
            damping = numbers[OWN + LOSS] / max(approach, numbers[OWN + LEAST_APPROACH])
        normal = depth
        if power != 1.0:
            normal = math.copysign(abs(depth) ** power, depth)
        normal = normal * numbers[OWN + STIFFNESS] * max(1.0 + damping * rate, 0.0)
        along = 0.0
        if numbers[OWN + FRICTION] > 0.0:
            slip = nx * state[VY] - ny * state[VX] + state[OMEGA] * numbers[OWN + JOURNAL]
            creep = numbers[OWN + CREEP]
            share = min(max((abs(slip) - creep) / (numbers[OWN + SLIDE] - creep), 0.0), 1.0)
            along = -numbers[OWN + FRICTION] * math.copysign(share, slip) * normal
        out[FX] = -normal * nx - along * ny
        out[FY] = -normal * ny + along * nx
        out[TORQUE] = along * numbers[OWN + JOURNAL]
