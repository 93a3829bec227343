"""Two-stroke cycle of one turn: compression, expansion with heat after Wiebe, open ports.

p = p_scavenge (V_c / V)^n_c                                            ports closed, before it burns
p = [p_s V_s^n_e + (n_e - 1) Q int V^(n_e - 1) dx_b] / V^n_e            until the ports open; s: start of burning
p = p_scavenge                                                          until they close
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
from mbsd.model.cylinders.four_stroke import ATMOSPHERE


@dataclass(frozen=True)
class TwoStroke(BurningCycle):
    """See :func:`two_stroke`."""

    scavenge: float
    ports_close: float
    ports_open: float

    turns = 1

    def openings(self, phi: float, bore: Bore) -> tuple[Opening, ...]:
        """The port in the wall, which the piston opens."""
        since = (phi - self.ports_close) % self.period
        return (Opening(since >= self.ports_open - self.ports_close, float(bore.height(self.ports_open))),)

    def phases(self, bore: Bore) -> tuple[Phase, ...]:
        """From where the ports close. Those in which they are open are two, so that there is an even number."""
        squeezed, burning = self.closed(bore, self.ports_close, self.scavenge, self.ports_open)
        out = opened(burning, self.ports_open, self.scavenge, self.passage)
        middle = 0.5 * (out[-1].begin + self.ports_close + TURN)
        return squeezed, burning, *out, *([level(middle, self.scavenge)] if len(out) % 2 else [])


def two_stroke(
    compression: float,
    heat: float | None = None,
    heat_density: float | None = None,
    start: float = math.radians(-15.0),
    duration: float = math.radians(50.0),
    a: float = 5.0,
    n: float = 3.0,
    scavenge: float = ATMOSPHERE,
    compression_exponent: float = 1.32,
    expansion_exponent: float = 1.28,
    ports_close: float = math.radians(-110.0),
    ports_open: float = math.radians(110.0),
    passage: float = 0.0,
) -> GasCycle:
    """Return a two-stroke cycle for :func:`gas_cycle`; angles (rad) count from the top dead centre.

    It fires at each of them.

    ``compression``: ratio of the largest to the least volume, over the whole stroke. ``heat``: what the charge gives to
    the gas in all (J), or ``heat_density`` by the displaced volume (J/m^3); it burns from ``start`` over ``duration``
    after Wiebe's function with ``a`` and ``n``. ``scavenge``: pressure (Pa) while the ports are open, from
    ``ports_open`` to ``ports_close`` in the next turn. ``passage``: angle (rad) over which the pressure falls to it,
    0: at once. Raises ModelError.
    """
    what = "two_stroke"
    own = numbers_given(
        what,
        ("duration", "a", "scavenge"),
        {"n": 1.0, "passage": 0.0, "compression_exponent": 1.0, "expansion_exponent": 1.01},
        start=start, duration=duration, a=a, n=n, scavenge=scavenge, compression_exponent=compression_exponent,
        expansion_exponent=expansion_exponent, ports_close=ports_close, ports_open=ports_open, passage=passage,
    )  # fmt: skip
    given = heat_given(what, heat, heat_density)
    in_order(
        what,
        {
            "-180 degrees": -math.pi - 1e-9,
            "ports_close": own["ports_close"],
            "start": own["start"],
            "ports_open": own["ports_open"],
            "180 degrees": math.pi + 1e-9,
        },
    )
    if own["ports_open"] + own["passage"] >= own["ports_close"] + TURN:
        raise ModelError(f"{what}: passage is {own['passage']:g} rad; it must end before the ports close")
    return TwoStroke(compression_given(what, compression), *given, **own)
