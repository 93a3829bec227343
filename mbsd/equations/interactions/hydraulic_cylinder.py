"""Hydraulic cylinder between two points: its force and how its pressures change; the law is in
forces/hydraulic_cylinder.py, and once more on arrays in oil_cylinder.py."""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal
from mbsd.equations.interactions.law import LAW, OWN, OWN_STATE, RATE, act_along, end_stop, interaction, measure

(
    ONE, OPENING, AREA_A, AREA_B, RETRACTED, STROKE, DEAD_A, DEAD_B, COMPRESSIBILITY, AIR, LEAST, SUPPLY, TANK,
    CONDUCTANCE, TRANSITION, LEAK, OUTSIDE, FRICTION, SLIP_SPEED, STOP, STOP_DAMPING,
) = range(OWN, OWN + 21)  # fmt: skip
"""ONE: pressure (Pa) of a state of 1. COMPRESSIBILITY: 1 / bulk modulus (1/Pa). AIR: part of air by its pressure (Pa).
LEAST: pressure (Pa) below which the bulk modulus is the one there while oil is compressed."""
SWITCHES = True
LITTLE = 1e-3
"""Part of its dead volume that a chamber keeps at least while a step is tried."""


@internal
def orifice(drop, transition):
    """Return the root of the pressure drop (Pa) with its sign, linear where that is below ``transition``."""
    return drop / math.sqrt(math.sqrt(drop * drop + transition * transition))


@internal
def bulk(pressure, flow, compressibility, air, least):
    """Return the bulk modulus (Pa) of oil with air at an absolute pressure (Pa).

    It is compressed by ``flow`` (m^3/s).
    """
    p = max(pressure, least if flow > 0.0 or air == 0.0 else 0.0)
    return (p + air) * p / (p * p * compressibility + air)


@interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above."""
    length, rate, ux, uy = measure(False, state)
    a = numbers[ONE] * state[OWN_STATE]
    b = numbers[ONE] * state[OWN_STATE + 1]
    opening = min(max(numbers[OPENING] + state[LAW], -1.0), 1.0)
    if opening > 0.0:
        at_a = numbers[SUPPLY]
        at_b = numbers[TANK]
    else:
        at_a = numbers[TANK]
        at_b = numbers[SUPPLY]
    flow = numbers[CONDUCTANCE] * abs(opening)
    through = numbers[LEAK] * (a - b)
    into_a = flow * orifice(at_a - a, numbers[TRANSITION]) - through
    into_b = flow * orifice(at_b - b, numbers[TRANSITION]) + through
    out_by = length - numbers[RETRACTED]
    volume_a = max(numbers[DEAD_A] + numbers[AREA_A] * out_by, LITTLE * numbers[DEAD_A])
    volume_b = max(numbers[DEAD_B] + numbers[AREA_B] * (numbers[STROKE] - out_by), LITTLE * numbers[DEAD_B])
    into_a -= numbers[AREA_A] * rate
    into_b += numbers[AREA_B] * rate
    bulk_a = bulk(a, into_a, numbers[COMPRESSIBILITY], numbers[AIR], numbers[LEAST])
    bulk_b = bulk(b, into_b, numbers[COMPRESSIBILITY], numbers[AIR], numbers[LEAST])
    out[RATE] = bulk_a / volume_a * into_a / numbers[ONE]
    out[RATE + 1] = bulk_b / volume_b * into_b / numbers[ONE]
    size = a * numbers[AREA_A] - b * numbers[AREA_B] - numbers[OUTSIDE] * (numbers[AREA_A] - numbers[AREA_B])
    size -= numbers[FRICTION] * math.tanh(rate / numbers[SLIP_SPEED])
    size -= end_stop(state, out, out_by, rate, numbers[STROKE], numbers[STOP], numbers[STOP_DAMPING])
    act_along(out, False, size, ux, uy)
