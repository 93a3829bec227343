"""Part of a spring whose stiffness, damping or free length is a law of time (forces/spring.py)."""

from __future__ import annotations

from mbsd.base.codes import DAMPER, STIFFNESS
from mbsd.equations.interactions.law import LAW, OWN, act_along, interaction, measure


@interaction
def force(numbers, state, out):
    """Fill the force; numbers: index of the law, free value or stiffness, and 1 for a torsion spring.

    The index names the one of the three that the law is.
    """
    turning = numbers[OWN + 2] > 0.0
    x, rate, ux, uy = measure(turning, state)
    if numbers[OWN] == STIFFNESS:
        size = -state[LAW] * (x - numbers[OWN + 1])
    elif numbers[OWN] == DAMPER:
        size = -state[LAW] * rate
    else:
        size = numbers[OWN + 1] * state[LAW]
    act_along(out, turning, size, ux, uy)
