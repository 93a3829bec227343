"""Which side of their kinks and jumps interactions are on, for integrators that end their steps there.

A force that switches tells a number s (m) that changes its sign there: the depth of a contact, say. While a step is
tried the force may be held on the side on which it began, and goes on smoothly beyond s = 0; how far it went beyond is
noted here. Else (HELD is 0) it is what its law says.

Source: Hairer, Norsett, Wanner, Solving ODEs I, II.6 (discontinuities).
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined

SWITCHING, HELD, BEYOND, NEAR, SIZE, CUTS, FREE, RATE, AT = range(9)
"""Row 0: whether any interaction switches; whether they are held; the earliest time (s) at which one was beyond by
more than NEAR (m); the mechanism's size (m); steps refused one after the other because of a switch; whether the next
step holds none; how fast s goes where the last switch was found (m/s),
and after a step that ended there the next step (s); the time at which the next step begins (s)."""
KEPT, VALUE, HERE, END, LAW_HERE, LAW_RATE_HERE, ROUGH, LOOSE, BEFORE = range(9)
"""Row k + 1, interaction k: its side while held, 0 for none; s where it was evaluated last, where the step begins and
where it ends, not a number where it does not switch; its law of time and the law's rate, 0 without one; the power of s
by which its force grows, if that is no whole number, else 0; steps, this one included, for which it is not
held; scratch of KEPT."""
WIDTH = 9
TIGHT = 1e-12
"""Of the size: interactions so near to their switch are on neither side."""


@inlined
def begin_sides(switch, t, started):
    """Go on at the time t; hold none in the first step of a run, or where sides are those of another time."""
    switch[0, HELD] = 0.0
    switch[0, CUTS] = 0.0
    switch[0, FREE] = 0.0
    if not started or t != switch[0, AT]:
        switch[0, FREE] = 1.0
        for row in range(1, switch.shape[0]):
            switch[row, LOOSE] = 0.0


@inlined
def hold(switch, near):
    """Hold each on the side on which the step begins; going ``near`` (m) beyond does not count."""
    tight = TIGHT * switch[0, SIZE]
    for row in range(1, switch.shape[0]):
        side = 0.0
        if switch[0, FREE] == 0.0 and switch[row, LOOSE] == 0.0:
            if switch[row, HERE] > tight:
                side = 1.0
            elif switch[row, HERE] < -tight:
                side = -1.0
        switch[row, KEPT] = side
    switch[0, NEAR] = near
    switch[0, BEYOND] = math.inf
    switch[0, HELD] = 1.0


@inlined
def note_end(switch):
    """The last evaluation was where the step ends."""
    for row in range(1, switch.shape[0]):
        switch[row, END] = switch[row, VALUE]


@inlined
def accept(switch, t):
    """The next step begins where this one ends, at the time t."""
    switch[0, AT] = t
    switch[0, CUTS] = 0.0
    switch[0, FREE] = 0.0
    for row in range(1, switch.shape[0]):
        switch[row, HERE] = switch[row, END]
        switch[row, LOOSE] = max(switch[row, LOOSE] - 1.0, 0.0)


@inlined
def farthest(switch, column):
    """How far the one is beyond its switch that is farthest (m), below 0 before it."""
    far = -math.inf
    for row in range(1, switch.shape[0]):
        if switch[row, KEPT] != 0.0:
            far = max(far, -switch[row, KEPT] * switch[row, column])
    return far
