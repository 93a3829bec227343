"""Gas behind a piston over the cycle of an engine; the law is in model/cylinders/cycle.py.

The phases take turns at being the side above and the side below the switch, so that there is an even number of them;
the switch is the way of the crank to the nearest change of phases.
"""

from __future__ import annotations

import math

from mbsd.equations.interactions.law import CRANK, CRANK_RATE, FX, FY, OWN, SIDE, SWITCH, TORQUE, X, interaction

AREA, OUTSIDE, SHIFT, BOTTOM, SENSE, FIRES_AT, FIRST, PERIOD, LEVER, COUNT, HEAD = range(11)
"""Places of the own numbers: m^2, Pa, m, m, 1 or -1, three angles (rad), m/rad, phases; the phases follow from HEAD."""
BEGIN, EXPONENT, TO, WIDTH, PIECES, PIECE_COUNT, PHASE = range(7)
"""Places in the numbers of a phase: BEGIN counts from FIRST, PIECES is where its pieces begin among the own numbers."""
PIECE = 7
"""Numbers of a piece: where it begins (rad), six coefficients by rising powers."""
NUDGE = 1e-10
"""rad: so near to a change of phases it counts as passed, whatever rounding makes of the angle."""
SWITCHES = True


@interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above."""
    own = OWN
    first = numbers[own + FIRST]
    period = numbers[own + PERIOD]
    count = int(numbers[own + COUNT])
    since = (numbers[own + SENSE] * (state[CRANK] - numbers[own + FIRES_AT]) - first) % period
    if since >= period:
        since -= period
    k = 0
    while k + 1 < count and numbers[own + HEAD + PHASE * (k + 1) + BEGIN] <= since:
        k += 1
    low = since - numbers[own + HEAD + PHASE * k + BEGIN]
    end = period
    if k + 1 < count:
        end = numbers[own + HEAD + PHASE * (k + 1) + BEGIN]
    high = end - since
    parity = 1.0 - 2.0 * (k % 2)
    step = 0
    out[SWITCH] = math.nan
    if count > 1:
        out[SWITCH] = parity * numbers[own + LEVER] * min(low, high)
        if state[SIDE] != 0.0:
            if state[SIDE] * parity < 0.0:  # beyond the end of the phase in which the step began
                step = 1
                if low < high:
                    step = -1
        elif numbers[own + SENSE] * state[CRANK_RATE] >= 0.0:
            if high < NUDGE:
                step = 1
        elif low < NUDGE:
            step = -1
    k += step
    if k == count:
        k = 0
        since -= period
    elif k < 0:
        k = count - 1
        since += period
    row = own + HEAD + PHASE * k
    angle = first + since
    at = own + int(numbers[row + PIECES])
    left = 0
    right = int(numbers[row + PIECE_COUNT])
    while right - left > 1:
        middle = (left + right) // 2
        if numbers[at + PIECE * middle] <= angle:
            left = middle
        else:
            right = middle
    at += PIECE * left
    ahead = angle - numbers[at]
    pressure = 0.0
    for c in range(6, 0, -1):
        pressure = pressure * ahead + numbers[at + c]
    if numbers[row + EXPONENT] != 0.0:
        height = state[X] + numbers[own + SHIFT]
        pressure *= (numbers[own + BOTTOM] / height) ** numbers[row + EXPONENT]
    if numbers[row + WIDTH] > 0.0:
        u = (since - numbers[row + BEGIN]) / numbers[row + WIDTH]
        pressure += u * u * u * (10.0 - 15.0 * u + 6.0 * u * u) * (numbers[row + TO] - pressure)
    out[FX] = numbers[own + AREA] * (pressure - numbers[own + OUTSIDE])
    out[FY] = 0.0
    out[TORQUE] = 0.0
