"""Flanks of two gears that touch on one side of their teeth; the law is in forces/gear_mesh.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions import law

MIDDLE, FLANK, BASE_I, BASE_J, HALF, INVOLUTE, PERIOD, STIFFNESS, EXPONENT, DAMPING, LOSS, LEAST_APPROACH = range(12)
SWITCHES = True


@law.interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above. In a ring the base radius of gear j is negative."""
    out[law.FX] = 0.0
    out[law.FY] = 0.0
    out[law.TORQUE] = 0.0
    flank = numbers[law.OWN + FLANK]
    base = numbers[law.OWN + BASE_J]
    both = numbers[law.OWN + BASE_I] + base
    way = 1.0 if base > 0.0 else -1.0
    distance = math.sqrt(state[law.X] * state[law.X] + state[law.Y] * state[law.Y])
    if distance == 0.0:
        return
    ux = state[law.X] / distance
    uy = state[law.Y] / distance
    rolled = base * state[law.A] - both * math.atan2(state[law.Y], state[law.X]) - numbers[law.OWN + MIDDLE]
    period = numbers[law.OWN + PERIOD]
    rolled -= period * math.floor(rolled / period + 0.5)
    cosine = min(both / distance, 1.0)
    sine = math.sqrt(1.0 - cosine * cosine)
    opened = both * (sine / cosine - math.acos(cosine) - numbers[law.OWN + INVOLUTE])
    depth = flank * rolled - way * opened - numbers[law.OWN + HALF]
    turning = (ux * state[law.VY] - uy * state[law.VX]) / distance
    parting = ux * state[law.VX] + uy * state[law.VY]
    rate = flank * (base * state[law.OMEGA] - both * turning) - way * sine * parting
    exponent = numbers[law.OWN + EXPONENT]
    law.note(out, depth, rate, exponent)
    if law.touches(state, depth):
        normal = law.normal_force(
            state, depth, rate, numbers[law.OWN + STIFFNESS], exponent, numbers[law.OWN + DAMPING],
            numbers[law.OWN + LOSS], numbers[law.OWN + LEAST_APPROACH],
        )  # fmt: skip
        across = normal * flank * both / distance
        apart = normal * way * sine
        out[law.FX] = apart * ux - across * uy
        out[law.FY] = apart * uy + across * ux
        out[law.TORQUE] = -normal * flank * base
