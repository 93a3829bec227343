"""Inertial forces on a body in a turning frame; the law is in forces/rotating_frame.py."""

from __future__ import annotations

from mbsd.equations.interactions.law import FX, FY, LAW, LAW_RATE, OWN, TORQUE, VX, VY, X, Y, interaction


@interaction
def force(numbers, state, out):
    """Fill the force; numbers: mass, inertia, constant rate, to which the law of time is added."""
    mass = numbers[OWN]
    rate = numbers[OWN + 2] + state[LAW]
    out[FX] = mass * (rate * rate * state[X] + 2.0 * rate * state[VY] + state[LAW_RATE] * state[Y])
    out[FY] = mass * (rate * rate * state[Y] - 2.0 * rate * state[VX] - state[LAW_RATE] * state[X])
    out[TORQUE] = -numbers[OWN + 1] * state[LAW_RATE]
