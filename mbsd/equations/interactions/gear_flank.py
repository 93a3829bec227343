"""Flanks of two gears that touch on one side of their teeth; the law is in forces/gear_mesh.py."""

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
    A,
    X,
    Y,
    interaction,
    normal_force,
    note,
    touches,
)

MIDDLE, FLANK, BASE_I, BASE_J, HALF, INVOLUTE, PERIOD, STIFFNESS, EXPONENT, DAMPING, LOSS, LEAST_APPROACH = range(12)
SWITCHES = True


@interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above. In a ring the base radius of gear j is negative."""
    out[FX] = 0.0
    out[FY] = 0.0
    out[TORQUE] = 0.0
    flank = numbers[OWN + FLANK]
    base = numbers[OWN + BASE_J]
    both = numbers[OWN + BASE_I] + base
    way = 1.0 if base > 0.0 else -1.0
    distance = math.sqrt(state[X] * state[X] + state[Y] * state[Y])
    if distance == 0.0:
        return
    ux = state[X] / distance
    uy = state[Y] / distance
    rolled = base * state[A] - both * math.atan2(state[Y], state[X]) - numbers[OWN + MIDDLE]
    period = numbers[OWN + PERIOD]
    rolled -= period * math.floor(rolled / period + 0.5)
    cosine = min(both / distance, 1.0)
    sine = math.sqrt(1.0 - cosine * cosine)
    opened = both * (sine / cosine - math.acos(cosine) - numbers[OWN + INVOLUTE])
    depth = flank * rolled - way * opened - numbers[OWN + HALF]
    turning = (ux * state[VY] - uy * state[VX]) / distance
    parting = ux * state[VX] + uy * state[VY]
    rate = flank * (base * state[OMEGA] - both * turning) - way * sine * parting
    exponent = numbers[OWN + EXPONENT]
    note(out, depth, rate, exponent)
    if touches(state, depth):
        normal = normal_force(
            state, depth, rate, numbers[OWN + STIFFNESS], exponent, numbers[OWN + DAMPING], numbers[OWN + LOSS],
            numbers[OWN + LEAST_APPROACH],
        )  # fmt: skip
        across = normal * flank * both / distance
        apart = normal * way * sine
        out[FX] = apart * ux - across * uy
        out[FY] = apart * uy + across * ux
        out[TORQUE] = -normal * flank * base
