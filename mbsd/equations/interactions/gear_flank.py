"""Flanks of two gears that touch on one side of their teeth; the law is in forces/gear_mesh.py."""

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
    A,
    X,
    Y,
    interaction,
)

MIDDLE, FLANK, BASE_I, BASE_J, HALF, INVOLUTE, PERIOD, STIFFNESS, EXPONENT, DAMPING, LOSS, LEAST_APPROACH = range(12)
SWITCHES = True


@interaction
def force(numbers, state, out):
    """Own numbers by the names above: the base radius of gear j is below 0 in a ring."""
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
    power = numbers[OWN + EXPONENT]
    out[SWITCH] = depth
    out[SPEED] = rate
    out[POWER] = power if power != math.floor(power) else 0.0
    if state[SIDE] > 0.0 or (state[SIDE] == 0.0 and depth > 0.0):
        damping = numbers[OWN + DAMPING]
        approach = state[APPROACH]
        if numbers[OWN + LOSS] > 0.0 and approach == approach:  # no number: it began to move with teeth pressed in
            damping = numbers[OWN + LOSS] / max(approach, numbers[OWN + LEAST_APPROACH])
        normal = depth
        if power != 1.0:
            normal = math.copysign(abs(depth) ** power, depth)
        normal = normal * numbers[OWN + STIFFNESS] * max(1.0 + damping * rate, 0.0)
        across = normal * flank * both / distance
        apart = normal * way * sine
        out[FX] = apart * ux - across * uy
        out[FY] = apart * uy + across * ux
        out[TORQUE] = -normal * flank * base
