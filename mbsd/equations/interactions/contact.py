"""Contact of a disc or point with a surface; the law is in forces/contact.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions.law import FX, FY, OMEGA, TORQUE, VX, VY, interaction
from mbsd.equations.interactions.surface import DISTANCE, TX, TY, after, stand

RADIUS, STIFFNESS, EXPONENT, DAMPING, FRICTION, SLIP_SPEED = range(6)


@interaction
def force(numbers, state, out):
    """Own numbers by the names above."""
    stand(numbers, state)
    own = after(numbers)
    out[FX] = 0.0
    out[FY] = 0.0
    out[TORQUE] = 0.0
    depth = numbers[own + RADIUS] - state[DISTANCE]
    if depth > 0.0:
        tx = state[TX]
        ty = state[TY]
        rate = ty * state[VX] - tx * state[VY]
        normal = numbers[own + STIFFNESS] * depth ** numbers[own + EXPONENT] * (1.0 + numbers[own + DAMPING] * rate)
        normal = max(normal, 0.0)
        slip = tx * state[VX] + ty * state[VY] + state[OMEGA] * state[DISTANCE]
        along = -numbers[own + FRICTION] * math.tanh(slip / numbers[own + SLIP_SPEED]) * normal
        out[FX] = along * tx - normal * ty
        out[FY] = along * ty + normal * tx
        out[TORQUE] = along * state[DISTANCE]
