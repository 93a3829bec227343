"""Stretch of an elastic cable between two wheels about one centre; the law is in model/cables.py."""

from __future__ import annotations

from mbsd.equations.interactions import law

TURNED, RADIUS, STIFFNESS, DAMPING, PRELOAD, SLACKENS = range(6)
SWITCHES = True


@law.interaction
def force(numbers, state, out):
    """Fill the torque; own numbers by the names above. RADIUS is negative where the cable turns clockwise."""
    radius = numbers[law.OWN + RADIUS]
    stiffness = numbers[law.OWN + STIFFNESS]
    stretch = radius * (state[law.A] - numbers[law.OWN + TURNED]) + numbers[law.OWN + PRELOAD] / stiffness
    pull = stiffness * stretch + numbers[law.OWN + DAMPING] * radius * state[law.OMEGA]
    if numbers[law.OWN + SLACKENS] != 0.0:
        out[law.SWITCH] = stretch
        pull = max(pull, 0.0) if law.touches(state, stretch) else 0.0
    out[law.FX] = 0.0
    out[law.FY] = 0.0
    out[law.TORQUE] = -radius * pull
