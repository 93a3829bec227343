"""Gas strut between two points; the law is in forces/gas_strut.py."""

from __future__ import annotations

import math

from mbsd.equations.interactions.law import OWN, act_along, end_stop, interaction, measure

(
    FORCE, GAS, EXPONENT, LENGTH, STROKE, IN, OUT, END, END_WAY, FRICTION, SLIP_SPEED, STOP, STOP_DAMPING,
) = range(OWN, OWN + 13)  # fmt: skip
"""GAS: length of the gas in bores of the rod where the strut is extended (m)."""
SWITCHES = True


@interaction
def force(numbers, state, out):
    """Fill the force; own numbers by the names above."""
    length, rate, ux, uy = measure(False, state)
    in_by = numbers[LENGTH] - length
    size = numbers[FORCE] * (numbers[GAS] / (numbers[GAS] - in_by)) ** numbers[EXPONENT]
    way = math.tanh(rate / numbers[SLIP_SPEED])
    damping = numbers[OUT]
    if numbers[END_WAY] > 0.0:
        u = min(max(1.0 - in_by / numbers[END_WAY], 0.0), 1.0)
        damping += u * u * u * (10.0 - 15.0 * u + 6.0 * u * u) * (numbers[END] - damping)
    damping = numbers[IN] + 0.5 * (1.0 + way) * (damping - numbers[IN])
    size -= damping * rate + numbers[FRICTION] * way
    size += end_stop(state, out, in_by, -rate, numbers[STROKE], numbers[STOP], numbers[STOP_DAMPING])
    act_along(out, False, size, ux, uy)
