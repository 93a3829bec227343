"""Wheel on a road; the law is in forces/tyre.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions.law import (
    DISTANCE,
    FX,
    FY,
    OMEGA,
    SIDE,
    SWITCH,
    TORQUE,
    TX,
    TY,
    VX,
    VY,
    after,
    interaction,
    stand,
)

RADIUS, STIFFNESS, DAMPING, GRIP, SLOPE, SHAPE, CURVATURE, STANDSTILL = range(8)
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
    normal = numbers[own + STIFFNESS] * depth + numbers[own + DAMPING] * rate
    out[SWITCH] = min(depth, normal / numbers[own + STIFFNESS]) if numbers[own + STIFFNESS] > 0.0 else depth
    if state[SIDE] > 0.0 or (state[SIDE] == 0.0 and depth > 0.0 and normal > 0.0):
        speed = tx * state[VX] + ty * state[VY]
        low = numbers[own + STANDSTILL]
        slip = -(speed + state[OMEGA] * state[DISTANCE]) / math.sqrt(speed * speed + low * low)
        stretched = numbers[own + SLOPE] * slip
        bent = stretched - numbers[own + CURVATURE] * (stretched - math.atan(stretched))
        along = normal * numbers[own + GRIP] * math.sin(numbers[own + SHAPE] * math.atan(bent))
        out[FX] = along * tx - normal * ty
        out[FY] = along * ty + normal * tx
        out[TORQUE] = along * state[DISTANCE]
