"""Spring by a law of the user; forces/spring_law.py says which."""

from __future__ import annotations

from mbsd.compiling.callback import call
from mbsd.equations.interactions.law import OWN, TIME, X, Y, act_along, interaction, measure


@interaction
def force(numbers, state, out):
    """Fill the force; numbers: the address of a law of value and rate, and 1 for a torsion spring."""
    turning = numbers[OWN + 1] > 0.0
    value, rate, ux, uy = measure(turning, state)
    state[X] = value  # the place is not read again
    state[Y] = rate
    call(int(numbers[OWN]), state[TIME], state, out)  # pyright: ignore[reportCallIssue]
    size = out[0]
    act_along(out, turning, size, ux, uy)
