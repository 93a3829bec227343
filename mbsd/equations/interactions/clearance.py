"""Journal in a bearing with clearance; the law is in forces/clearance_joint.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions.law import (
    FX,
    FY,
    OMEGA,
    OWN,
    TORQUE,
    VX,
    VY,
    X,
    Y,
    interaction,
    normal_force,
    note,
    touches,
)

JOURNAL, CLEARANCE, STIFFNESS, EXPONENT, DAMPING, FRICTION, CREEP, SLIDE, LOSS, LEAST_APPROACH = range(10)
SWITCHES = True


@interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above."""
    out[FX] = 0.0
    out[FY] = 0.0
    out[TORQUE] = 0.0
    eccentricity = math.sqrt(state[X] * state[X] + state[Y] * state[Y])
    depth = eccentricity - numbers[OWN + CLEARANCE]
    nx = 0.0
    ny = 0.0
    if eccentricity > 0.0:
        nx = state[X] / eccentricity
        ny = state[Y] / eccentricity
    rate = nx * state[VX] + ny * state[VY]
    exponent = numbers[OWN + EXPONENT]
    note(out, depth, rate, exponent)
    if touches(state, depth):
        normal = normal_force(
            state, depth, rate, numbers[OWN + STIFFNESS], exponent, numbers[OWN + DAMPING], numbers[OWN + LOSS],
            numbers[OWN + LEAST_APPROACH],
        )  # fmt: skip
        along = 0.0
        if numbers[OWN + FRICTION] > 0.0:
            slip = nx * state[VY] - ny * state[VX] + state[OMEGA] * numbers[OWN + JOURNAL]
            creep = numbers[OWN + CREEP]
            share = min(max((abs(slip) - creep) / (numbers[OWN + SLIDE] - creep), 0.0), 1.0)
            along = -numbers[OWN + FRICTION] * math.copysign(share, slip) * normal
        out[FX] = -normal * nx - along * ny
        out[FY] = -normal * ny + along * nx
        out[TORQUE] = along * numbers[OWN + JOURNAL]
