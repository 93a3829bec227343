"""Gas in both chambers of a piston with a slide valve; the law is in model/forces/double_acting_cylinder.py."""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal
from mbsd.equations.interactions.law import BODY_X, BODY_Y, FX, FY, OWN, OWN_STATE, RATE, TORQUE, VX, X, interaction

(
    ONE, AREA_A, AREA_B, STROKE, DEAD_A, DEAD_B, SUPPLY, EXHAUST, OUTSIDE, EXPONENT, CONDUCTANCE, WIDTH, LAP,
    EXHAUST_LAP, PORT, VALVE_X, VALVE_Y, VALVE_AT,
) = range(OWN, OWN + 18)  # fmt: skip
"""ONE: pressure (Pa) of a state of 1. CONDUCTANCE: coefficient of discharge times the root of R T (m/s). VALVE_X,
VALVE_Y, VALVE_AT: the valve's travel is their sum with the place of its centre of mass in the axes of marker i."""
LITTLE = 1e-3
"""Part of its dead volume that a chamber keeps at least while a step is tried."""
EDGE = 0.02
"""Part of its width, or of its opening, over which a port begins to open: its edge is round."""
SMOOTH = 1e-3
"""Part of the higher pressure below which the drop makes a laminar flow."""


@internal
def opened(travel, lap, port, width):
    """Return how far a port is open (m) at a travel of the valve (m)."""
    edge = EDGE * min(port, width)
    part = min(max((travel - lap) / edge, 0.0), 1.0)
    return min(max(travel - lap, 0.0), port) * part * part * (3.0 - 2.0 * part)


@internal
def flow(above, below, exponent):
    """Return the flow by a port's area and conductance (Pa) from one pressure to another, choked where it must be."""
    sense = 1.0
    if below > above:
        sense = -1.0
        above, below = below, above
    if above <= 0.0:
        return 0.0
    critical = (2.0 / (exponent + 1.0)) ** (exponent / (exponent - 1.0))
    ratio = max(below / above, critical)
    drop = 1.0 - ratio
    root = drop / math.sqrt(math.sqrt(drop * drop + SMOOTH * SMOOTH))
    slope = 1.0  # of r^(2/n) - r^((n+1)/n) by 1 - r, times n / (n - 1), which is smooth
    if drop > 1e-9:
        fall = ratio ** (2.0 / exponent) - ratio ** ((exponent + 1.0) / exponent)
        slope = fall / drop * exponent / (exponent - 1.0)
    return sense * above * root * math.sqrt(2.0 * slope)


@internal
def filled(numbers, pressure, travel):
    """Return p q (W) by R T of gas that flows into a chamber under ``pressure`` (Pa): p' = n / V (it - p V')."""
    inlet = opened(travel, numbers[LAP], numbers[PORT], numbers[WIDTH])
    outlet = opened(-travel, numbers[EXHAUST_LAP], numbers[PORT], numbers[WIDTH])
    into = inlet * flow(numbers[SUPPLY], pressure, numbers[EXPONENT])
    into += outlet * flow(numbers[EXHAUST], pressure, numbers[EXPONENT])
    return numbers[CONDUCTANCE] * numbers[WIDTH] * into


@interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above."""
    x = state[X]
    rate = state[VX]
    a = numbers[ONE] * state[OWN_STATE]
    b = numbers[ONE] * state[OWN_STATE + 1]
    travel = numbers[VALVE_X] * state[BODY_X] + numbers[VALVE_Y] * state[BODY_Y] + numbers[VALVE_AT]
    volume_a = max(numbers[DEAD_A] + numbers[AREA_A] * x, LITTLE * numbers[DEAD_A])
    volume_b = max(numbers[DEAD_B] + numbers[AREA_B] * (numbers[STROKE] - x), LITTLE * numbers[DEAD_B])
    exponent = numbers[EXPONENT]
    into_a = filled(numbers, a, travel)
    into_b = filled(numbers, b, -travel)
    out[RATE] = exponent / volume_a * (into_a - a * numbers[AREA_A] * rate) / numbers[ONE]
    out[RATE + 1] = exponent / volume_b * (into_b + b * numbers[AREA_B] * rate) / numbers[ONE]
    out[FX] = a * numbers[AREA_A] - b * numbers[AREA_B] - numbers[OUTSIDE] * (numbers[AREA_A] - numbers[AREA_B])
    out[FY] = 0.0
    out[TORQUE] = 0.0
