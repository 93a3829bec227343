"""Sides of kinks and jumps that interactions are on, for integrators that end their steps there.

A force that switches tells a number s (m) that changes its sign there: the depth of a contact, say. While a step is
tried the force may be held on the side on which it began, and goes on smoothly beyond s = 0; how far it went beyond is
noted here. Else (HELD is 0) it is what its law says.

Source: Hairer, Norsett, Wanner, Solving ODEs I, II.6 (discontinuities).
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined

SWITCHING, HELD, BEYOND, NEAR, SIZE, CUTS, FREE, RATE, AT, REMEMBERS = range(10)
"""Row 0: whether any interaction switches; whether they are held; the earliest time (s) at which one was beyond by
more than NEAR (m); the mechanism's size (m); steps refused one after the other because of a switch; whether the next
step holds none; how fast s goes where the last switch was found (m/s),
and after a step that ended there the next step (s); the time at which the next step begins (s); whether any force asks
for the speed at which its switch was passed."""
KEPT, VALUE, HERE, END, LAW_HERE, LAW_RATE_HERE, ROUGH, LOOSE, BEFORE, SPEED_HERE, SPEED_END, APPROACHED = range(12)
"""Row k + 1, interaction k: its side while held, 0 for none; s where it was evaluated last, where the step begins and
where it ends, not a number where it does not switch; its law of time and the law's rate, 0 without one; the power of s
by which its force grows, if that is no whole number, else 0; steps, this one included, for which it is not
held; scratch of KEPT; rate of s where it was evaluated last and where the step ends; that rate where s last went above
0, not a number before it ever did: events may set it back, so a run keeps it at events."""
WIDTH = 12
TIGHT = 1e-12
"""Fraction of the size: interactions so near to their switch are on neither side."""


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
    """Record that the last evaluation was where the step ends."""
    for row in range(1, switch.shape[0]):
        switch[row, END] = switch[row, VALUE]
        switch[row, SPEED_END] = switch[row, SPEED_HERE]


@inlined
def note_begin(switch):
    """Record that the run begins or goes on here: sides are known, contacts keep their approach.

    What is before its switch has the rate that it has now, whatever it was before an impact.
    """
    switch[0, FREE] = 0.0
    for row in range(1, switch.shape[0]):
        switch[row, HERE] = switch[row, VALUE]
        before = switch[row, APPROACHED]
        tight = TIGHT * switch[0, SIZE]
        if switch[row, VALUE] < -tight or (before != before and abs(switch[row, VALUE]) <= tight):
            switch[row, APPROACHED] = switch[row, SPEED_HERE]


@inlined
def accept(switch, t):
    """Begin the next step where this one ends, at the time t.

    What is before its switch, or ends there (LOOSE is 2), passes it at the rate that it has now. A step that passed a
    switch unseen began before it, at the rate noted then, and passed it in between; the one after a switch that was met
    (LOOSE is 1) did not.
    """
    switch[0, AT] = t
    switch[0, CUTS] = 0.0
    switch[0, FREE] = 0.0
    tight = TIGHT * switch[0, SIZE]
    for row in range(1, switch.shape[0]):
        loose = switch[row, LOOSE]
        here = switch[row, HERE]
        end = switch[row, END]
        if end < -tight or loose == 2.0:
            switch[row, APPROACHED] = switch[row, SPEED_END]
        elif loose != 1.0 and here < -tight:
            noted = switch[row, APPROACHED]
            part = here / (here - end) if noted == noted and end > 0.0 else 1.0
            switch[row, APPROACHED] = (
                noted + part * (switch[row, SPEED_END] - noted) if part < 1.0 else switch[row, SPEED_END]
            )
        switch[row, HERE] = switch[row, END]
        switch[row, LOOSE] = max(switch[row, LOOSE] - 1.0, 0.0)


@inlined
def farthest(switch, column):
    """Return how far the one is beyond its switch that is farthest (m), below 0 before it."""
    far = -math.inf
    for row in range(1, switch.shape[0]):
        if switch[row, KEPT] != 0.0:
            far = max(far, -switch[row, KEPT] * switch[row, column])
    return far
