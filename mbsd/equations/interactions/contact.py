"""Contact of a disc or point with a surface; the law is in forces/contact.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions import law

RADIUS, STIFFNESS, EXPONENT, DAMPING, FRICTION, SLIP_SPEED, LOSS, LEAST_APPROACH = range(8)
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
    exponent = numbers[own + EXPONENT]
    law.note(out, depth, rate, exponent)
    if law.touches(state, depth):
        normal = law.normal_force(
            state, depth, rate, numbers[own + STIFFNESS], exponent, numbers[own + DAMPING], numbers[own + LOSS],
            numbers[own + LEAST_APPROACH],
        )  # fmt: skip
        along = 0.0
        if numbers[own + FRICTION] > 0.0:
            slip = tx * state[law.VX] + ty * state[law.VY] + state[law.OMEGA] * state[law.DISTANCE]
            along = -numbers[own + FRICTION] * math.tanh(slip / numbers[own + SLIP_SPEED]) * normal
        out[law.FX] = along * tx - normal * ty
        out[law.FY] = along * ty + normal * tx
        out[law.TORQUE] = along * state[law.DISTANCE]
