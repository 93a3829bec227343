"""Steps of drivers' laws from one time to the next: which of them can be followed."""

from __future__ import annotations

from mbsd.compiling.jit import inlined

JUMP = 0.25
"""Part of a law's step that its rates may leave unexplained."""


@inlined
def jumps(law, before, h, stride):
    """Return True if a law's value (3,) is over ``stride`` from that h before, or off its rates' lead.

    h is in s.
    """
    step = law[0] - before[0]
    gap = step - h * (0.5 * (law[1] + before[1]) - h / 12.0 * (law[2] - before[2]))
    if not (abs(step) <= stride and h * abs(law[1]) <= stride and h * abs(before[1]) <= stride):
        return True
    return not abs(gap) <= JUMP * abs(step) + 1e-9
