"""Contact of a disc or point with a surface; the law is in forces/contact.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions.law import (
    APPROACH,
    FX,
    FY,
    OMEGA,
    POWER,
    SIDE,
    SPEED,
    SWITCH,
    TORQUE,
    VX,
    VY,
    interaction,
)
from mbsd.equations.interactions.surface import DISTANCE, TX, TY, after, stand

RADIUS, STIFFNESS, EXPONENT, DAMPING, FRICTION, SLIP_SPEED, LOSS, LEAST_APPROACH = range(8)
SWITCHES = True


@interaction
def force(numbers, state, out):
    """Own numbers by the names above."""
    stand(numbers, state)
    own = after(numbers)
    out[FX] = 0.0
    out[FY] = 0.0
    out[TORQUE] = 0.0
    depth = numbers[own + RADIUS] - state[DISTANCE]
    power = numbers[own + EXPONENT]
    tx = state[TX]
    ty = state[TY]
    rate = ty * state[VX] - tx * state[VY]
    out[SWITCH] = depth
    out[SPEED] = rate
    out[POWER] = power if power != math.floor(power) else 0.0
    if state[SIDE] > 0.0 or (state[SIDE] == 0.0 and depth > 0.0):
        damping = numbers[own + DAMPING]
        approach = state[APPROACH]
        if numbers[own + LOSS] > 0.0 and approach == approach:  # no number: it began to move within the surface
            damping = numbers[own + LOSS] / max(approach, numbers[own + LEAST_APPROACH])
        normal = depth
        if power != 1.0:
            normal = math.copysign(abs(depth) ** power, depth)
        normal = normal * numbers[own + STIFFNESS] * max(1.0 + damping * rate, 0.0)
        along = 0.0
        if numbers[own + FRICTION] > 0.0:
            slip = tx * state[VX] + ty * state[VY] + state[OMEGA] * state[DISTANCE]
            along = -numbers[own + FRICTION] * math.tanh(slip / numbers[own + SLIP_SPEED]) * normal
        out[FX] = along * tx - normal * ty
        out[FY] = along * ty + normal * tx
        out[TORQUE] = along * state[DISTANCE]
