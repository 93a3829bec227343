"""The normal force between two that touch, pressed ``depth`` into each other at the rate ``rate``:

N = k depth^e max(1 + D rate, 0),   D as given, or loss / approach, the speed with which the contact began
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined
from mbsd.equations.interactions.law import APPROACH, POWER, SIDE, SPEED, SWITCH


@inlined
def note(out, depth, rate, exponent):
    """Tell those who watch where contacts begin (switching.py) what this one does."""
    out[SWITCH] = depth
    out[SPEED] = rate
    out[POWER] = exponent if exponent != math.floor(exponent) else 0.0


@inlined
def touches(state, depth):
    """Return True if the two touch: as the step holds it, else by depth."""
    return state[SIDE] > 0.0 or (state[SIDE] == 0.0 and depth > 0.0)


@inlined
def normal_force(state, depth, rate, stiffness, exponent, damping, loss, least_approach):
    """N; ``loss`` above 0 takes the place of ``damping``."""
    approach = state[APPROACH]
    if loss > 0.0 and approach == approach:  # no number: the motion began with the two pressed into each other
        damping = loss / max(approach, least_approach)
    normal = depth
    if exponent != 1.0:
        normal = math.copysign(abs(depth) ** exponent, depth)
    return normal * stiffness * max(1.0 + damping * rate, 0.0)
