"""Contact of a disc or point with a surface; the law is in forces/contact.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions.law import (
    DISTANCE,
    FX,
    FY,
    OMEGA,
    TORQUE,
    TX,
    TY,
    VX,
    VY,
    after,
    interaction,
    normal_force,
    note,
    stand,
    touches,
)

RADIUS, STIFFNESS, EXPONENT, DAMPING, FRICTION, SLIP_SPEED, LOSS, LEAST_APPROACH = range(8)
SWITCHES = True


@interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above."""
    stand(numbers, state)
    own = after(numbers)
    out[FX] = 0.0
    out[FY] = 0.0
    out[TORQUE] = 0.0
    depth = numbers[own + RADIUS] - state[DISTANCE]
    tx = state[TX]
    ty = state[TY]
    rate = ty * state[VX] - tx * state[VY]
    exponent = numbers[own + EXPONENT]
    note(out, depth, rate, exponent)
    if touches(state, depth):
        normal = normal_force(
            state, depth, rate, numbers[own + STIFFNESS], exponent, numbers[own + DAMPING], numbers[own + LOSS],
            numbers[own + LEAST_APPROACH],
        )  # fmt: skip
        along = 0.0
        if numbers[own + FRICTION] > 0.0:
            slip = tx * state[VX] + ty * state[VY] + state[OMEGA] * state[DISTANCE]
            along = -numbers[own + FRICTION] * math.tanh(slip / numbers[own + SLIP_SPEED]) * normal
        out[FX] = along * tx - normal * ty
        out[FY] = along * ty + normal * tx
        out[TORQUE] = along * state[DISTANCE]
