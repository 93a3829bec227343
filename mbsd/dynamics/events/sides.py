"""The side of zero on which the function of an event is: its value, what of it is rounding, where it goes next."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.dynamics.events.bounds import AHEAD, BEYOND, NEAR, ROUNDINGS
from mbsd.dynamics.events.moment import Moment
from mbsd.dynamics.events.monitors import checked
from mbsd.dynamics.state import TIME, State
from mbsd.model.event import Event


def value_of(packed: Packed, event: Event, state: State) -> float:
    """The value of an event's function at a state."""
    return checked(packed, event, Moment(packed, float(state.clock[TIME]), state.y[0], state.y[1]))


def rounding_of(packed: Packed, event: Event, value: float, state: State) -> float:
    """How much the value of an event at a state changes where that does by what counts as no distance."""
    sizes = np.concatenate([np.zeros(3), packed.column_scale()])
    time, most = float(state.clock[TIME]), 0.0
    for signs in ROUNDINGS:
        away = NEAR * sizes * np.resize(signs, len(sizes))
        moment = Moment(packed, time * (1.0 + signs[0] * NEAR), state.y[0] + away, state.y[1] + away)
        most = max(most, abs(checked(packed, event, moment) - value))
    return most


def side_ahead(packed: Packed, event: Event, state: State, span: float) -> float:
    """The sign that an event whose value is zero has next; 0 if it stays zero. ``span``: duration (s)."""
    (q, v), a, time = state.y, state.dy[1], float(state.clock[TIME])
    value = value_of(packed, event, state)
    rounding = rounding_of(packed, event, value, state)
    if abs(value) > rounding:
        return float(np.sign(value))
    known = AHEAD[-1] * span
    for s in (*(part * span for part in AHEAD), *(after for after in BEYOND if after > known)):
        ahead = checked(packed, event, Moment(packed, time + s, q + s * v + s * s / 2 * a, v + s * a))
        if abs(ahead) > 10.0 * rounding:
            return float(np.sign(ahead))
    return 0.0
