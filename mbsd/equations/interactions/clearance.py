"""Journal in a bearing with clearance; the law is in forces/clearance_joint.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions import law

JOURNAL, CLEARANCE, STIFFNESS, EXPONENT, DAMPING, FRICTION, CREEP, SLIDE, LOSS, LEAST_APPROACH = range(10)
SWITCHES = True


@law.interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above."""
    out[law.FX] = 0.0
    out[law.FY] = 0.0
    out[law.TORQUE] = 0.0
    eccentricity = math.sqrt(state[law.X] * state[law.X] + state[law.Y] * state[law.Y])
    depth = eccentricity - numbers[law.OWN + CLEARANCE]
    nx = 0.0
    ny = 0.0
    if eccentricity > 0.0:
        nx = state[law.X] / eccentricity
        ny = state[law.Y] / eccentricity
    rate = nx * state[law.VX] + ny * state[law.VY]
    exponent = numbers[law.OWN + EXPONENT]
    law.note(out, depth, rate, exponent)
    if law.touches(state, depth):
        normal = law.normal_force(
            state, depth, rate, numbers[law.OWN + STIFFNESS], exponent, numbers[law.OWN + DAMPING],
            numbers[law.OWN + LOSS], numbers[law.OWN + LEAST_APPROACH],
        )  # fmt: skip
        along = 0.0
        if numbers[law.OWN + FRICTION] > 0.0:
            slip = nx * state[law.VY] - ny * state[law.VX] + state[law.OMEGA] * numbers[law.OWN + JOURNAL]
            creep = numbers[law.OWN + CREEP]
            share = min(max((abs(slip) - creep) / (numbers[law.OWN + SLIDE] - creep), 0.0), 1.0)
            along = -numbers[law.OWN + FRICTION] * math.copysign(share, slip) * normal
        out[law.FX] = -normal * nx - along * ny
        out[law.FY] = -normal * ny + along * nx
        out[law.TORQUE] = along * numbers[law.OWN + JOURNAL]
