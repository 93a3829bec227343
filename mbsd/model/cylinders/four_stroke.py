"""Four-stroke cycle of two turns: intake, compression, expansion with heat after Wiebe, exhaust.

    p = p_intake (V_c / V)^n_c                                             valves closed, before it burns
    p = [p_s V_s^n_e + (n_e - 1) Q int V^(n_e - 1) dx_b] / V^n_e           until the exhaust opens; s: where it burns
    p = p_exhaust                                                          until the valves change, at phi = 360 degrees
    p = p_intake                                                           until the intake closes

Sources: Heywood, Internal Combustion Engine Fundamentals, ch. 9 (heat release); Ferguson, Kirkpatrick, Internal
Combustion Engines, ch. 2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from mbsd.base.errors import ModelError
from mbsd.model.cylinders.cycle import (
    TURN,
    Bore,
    BurningCycle,
    GasCycle,
    Opening,
    Phase,
    compression_given,
    heat_given,
    in_order,
    level,
    numbers_given,
    opened,
)

ATMOSPHERE = 101325.0
"""Pa."""


@dataclass(frozen=True)
class FourStroke(BurningCycle):
    """See :func:`four_stroke`."""

    intake: float
    exhaust: float
    intake_closes: float
    exhaust_opens: float

    turns = 2

    def openings(self, phi: float, bore: Bore) -> tuple[Opening, ...]:
        """The intake valve and the exhaust valve."""
        since = (phi - self.intake_closes) % self.period
        exhaust, change = self.exhaust_opens - self.intake_closes, TURN - self.intake_closes
        return Opening(since >= change), Opening(exhaust <= since < change)

    def phases(self, bore: Bore) -> tuple[Phase, ...]:
        """From where the intake closes."""
        squeezed, burning = self.closed(bore, self.intake_closes, self.intake, self.exhaust_opens)
        out = opened(burning, self.exhaust_opens, self.exhaust, self.passage)
        return squeezed, burning, *out, *opened(level(TURN, self.exhaust), TURN, self.intake, self.passage)


def four_stroke(
    compression: float,
    heat: float | None = None,
    heat_density: float | None = None,
    start: float = math.radians(-15.0),
    duration: float = math.radians(50.0),
    a: float = 5.0,
    n: float = 3.0,
    intake: float = ATMOSPHERE,
    exhaust: float = ATMOSPHERE,
    compression_exponent: float = 1.32,
    expansion_exponent: float = 1.28,
    intake_closes: float = -math.pi,
    exhaust_opens: float = math.pi,
    passage: float = 0.0,
) -> GasCycle:
    """A four-stroke cycle for :func:`gas_cycle`; angles (rad) from the top dead centre at which it fires.

    ``compression``: ratio of the largest to the least volume. ``heat``: what the charge gives to the gas in all (J), or
    ``heat_density`` by the displaced volume (J/m^3); without either nothing burns. It burns from ``start`` over
    ``duration`` after Wiebe's function with ``a`` and ``n``. ``intake`` and ``exhaust``: pressures (Pa) while these
    valves are open; they change at 2 pi. ``passage``: angle (rad) over which the pressure passes to that beyond a valve
    that opens, 0: at once. Raises ModelError.
    """
    what = "four_stroke"
    own = numbers_given(
        what,
        ("duration", "a", "intake", "exhaust"),
        {"n": 1.0, "passage": 0.0, "compression_exponent": 1.0, "expansion_exponent": 1.01},
        start=start, duration=duration, a=a, n=n, intake=intake, exhaust=exhaust,
        compression_exponent=compression_exponent, expansion_exponent=expansion_exponent,
        intake_closes=intake_closes, exhaust_opens=exhaust_opens, passage=passage,
    )  # fmt: skip
    given = heat_given(what, heat, heat_density)
    in_order(
        what,
        {
            "-360 degrees": -TURN,
            "intake_closes": own["intake_closes"],
            "start": own["start"],
            "exhaust_opens": own["exhaust_opens"],
            "the end of the passage behind exhaust_opens": own["exhaust_opens"] + own["passage"] + 1e-9,
            "360 degrees": TURN,
        },
    )
    if own["exhaust_opens"] > math.pi or own["start"] <= -math.pi:
        raise ModelError(
            f"{what}: it starts at {math.degrees(own['start']):g} degrees and exhaust_opens is "
            f"{math.degrees(own['exhaust_opens']):g} degrees; both must lie within -180 .. 180 degrees. Give radians"
        )
    if TURN + own["passage"] >= own["intake_closes"] + 2.0 * TURN:
        raise ModelError(f"{what}: passage is {own['passage']:g} rad; it must end before the intake closes")
    return FourStroke(compression_given(what, compression), *given, **own)
