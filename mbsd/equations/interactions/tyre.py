"""Wheel on a road; the law is in forces/tyre.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions import law

RADIUS, STIFFNESS, DAMPING, GRIP, SLOPE, SHAPE, CURVATURE, STANDSTILL = range(8)
SWITCHES = True


@law.interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above."""
    law.stand(numbers, state)
    own = law.after(numbers)
    out[law.FX] = 0.0
    out[law.FY] = 0.0
    out[law.TORQUE] = 0.0
    depth = numbers[own + RADIUS] - state[law.DISTANCE]
    tx = state[law.TX]
    ty = state[law.TY]
    rate = ty * state[law.VX] - tx * state[law.VY]
    normal = numbers[own + STIFFNESS] * depth + numbers[own + DAMPING] * rate
    out[law.SWITCH] = min(depth, normal / numbers[own + STIFFNESS]) if numbers[own + STIFFNESS] > 0.0 else depth
    if state[law.SIDE] > 0.0 or (state[law.SIDE] == 0.0 and depth > 0.0 and normal > 0.0):
        speed = tx * state[law.VX] + ty * state[law.VY]
        low = numbers[own + STANDSTILL]
        slip = -(speed + state[law.OMEGA] * state[law.DISTANCE]) / math.sqrt(speed * speed + low * low)
        stretched = numbers[own + SLOPE] * slip
        bent = stretched - numbers[own + CURVATURE] * (stretched - math.atan(stretched))
        along = normal * numbers[own + GRIP] * math.sin(numbers[own + SHAPE] * math.atan(bent))
        out[law.FX] = along * tx - normal * ty
        out[law.FY] = along * ty + normal * tx
        out[law.TORQUE] = along * state[law.DISTANCE]
