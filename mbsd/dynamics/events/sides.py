"""The side of zero on which the function of an event is: its value, what of it is rounding, where it goes next."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import ModelError
from mbsd.dynamics.events.bounds import AHEAD, BEYOND, NEAR, ROUNDINGS
from mbsd.dynamics.events.moment import Moment
from mbsd.dynamics.events.monitors import checked
from mbsd.dynamics.state import TIME, State
from mbsd.model.event import Event

LESS = 1e-3
"""Part of NEAR by which a state is changed to tell a jump from a slope."""


def value_of(packed: Packed, event: Event, state: State) -> float:
    """The value of an event's function at a state."""
    return checked(packed, event, Moment(packed, float(state.clock[TIME]), state.y[0], state.y[1]))


def rounding_of(packed: Packed, event: Event, value: float, state: State, near: float = NEAR) -> float:
    """How much the value of an event at a state changes where that does by what counts as no distance."""
    sizes = np.concatenate([np.zeros(3), packed.column_scale()])
    time, most = float(state.clock[TIME]), 0.0
    for signs in ROUNDINGS:
        away = near * sizes * np.resize(signs, len(sizes))
        moment = Moment(packed, time * (1.0 + signs[0] * near), state.y[0] + away, state.y[1] + away)
        most = max(most, abs(checked(packed, event, moment) - value))
    return most


def refuse_chance(packed: Packed, event: Event, state: State) -> None:
    """Raise ModelError where rounding decides the sign of an event's function, which jumps at a state.

    A smooth function that is within rounding of zero changes by less where the state changes by less.
    """
    value = value_of(packed, event, state)
    jump = rounding_of(packed, event, value, state)
    if abs(value) > jump or rounding_of(packed, event, value, state, NEAR * LESS) < 0.5 * jump:
        return
    raise ModelError(
        f"{packed.name}: event '{event.name}' at t = {float(state.clock[TIME]):.6g} s: its function is {value:.6g}, "
        f"and changes by {jump:.6g} where places and speeds change by rounding alone, so that chance would decide "
        "whether the event happens. It jumps with the sign of something that is zero here, perhaps of a speed that a "
        "contact or a joint holds. Give a function that is smooth in time and motion"
    )


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
