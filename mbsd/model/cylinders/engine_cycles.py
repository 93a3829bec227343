"""Cycles of engines: four strokes, two strokes, and a measured pressure.

Four-stroke cycle of two turns: intake, compression, expansion with heat after Wiebe, exhaust.

    p = p_intake (V_c / V)^n_c                                             valves closed, before it burns
    p = [p_s V_s^n_e + (n_e - 1) Q int V^(n_e - 1) dx_b] / V^n_e           until the exhaust opens; s: where it burns
    p = p_exhaust                                                          until the valves change, at phi = 360 degrees
    p = p_intake                                                           until the intake closes

Sources: Heywood, Internal Combustion Engine Fundamentals, ch. 9 (heat release); Ferguson, Kirkpatrick, Internal
Combustion Engines, ch. 2.

Two-stroke cycle of one turn: compression, expansion with heat after Wiebe, open ports.

p = p_scavenge (V_c / V)^n_c                                            ports closed, before it burns
p = [p_s V_s^n_e + (n_e - 1) Q int V^(n_e - 1) dx_b] / V^n_e            until the ports open; s: start of burning
p = p_scavenge                                                          until they close

A measured or computed pressure over the angle of the crank, repeated with the cycle.

p(phi)      cubic pieces through the points that keep their rises and falls (Fritsch, Carlson 1980), periodic
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
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
from mbsd.model.laws.law import rising_rows

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


FEWEST = 4
CLOSED = 1e-9
"""Part of the largest pressure by which a table that has both ends of its cycle may differ there."""


@dataclass(frozen=True)
class PressureTable(GasCycle):
    """See :func:`pressure_table`."""

    angles: tuple[float, ...]
    pressures: tuple[float, ...]
    turns: int
    compression: float | None

    def phases(self, bore: Bore) -> tuple[Phase, ...]:
        """One, from the first angle on."""
        from scipy.interpolate import PchipInterpolator

        x, y = np.array(self.angles), np.array(self.pressures)
        if x[-1] - x[0] < self.period * (1.0 - 1e-12):
            x, y = np.append(x, x[0] + self.period), np.append(y, y[0])
        # Three points of the neighbouring cycles on both sides, so that slopes agree where cycles meet.
        around = np.concatenate([x[-4:-1] - self.period, x, x[1:4] + self.period])
        smooth = PchipInterpolator(around, np.concatenate([y[-4:-1], y, y[1:4]]))
        rows = smooth.c[::-1, 3 : 3 + len(x) - 1].T
        pieces = tuple((*row, 0.0, 0.0) for row in rows.tolist())
        return (Phase(float(x[0]), 0.0, tuple(x.tolist()), pieces),)


def pressure_table(angles: object, pressures: object, turns: int = 2, compression: float | None = None) -> GasCycle:
    """Return a cycle of absolute pressures (Pa) at rising angles (rad), over one cycle.

    Angles count from the top dead centre at which it fires.

    ``turns`` of the crank in a cycle: 2 of a four-stroke engine, 1 of a two-stroke engine. The table may end where it
    begins, a cycle later. ``compression``: ratio of the largest to the least volume; without it volumes count from the
    top dead centre. Raises ModelError.
    """
    what = "pressure_table"
    x, y = rising_rows(what, FEWEST, angles=angles, pressures=pressures)
    if isinstance(turns, bool) or turns not in (1, 2):
        raise ModelError(f"{what}: turns is {shown(turns)}; a cycle has 2 turns of the crank (four strokes) or 1 (two)")
    span, period = float(x[-1] - x[0]), 2.0 * math.pi * turns
    if span > period * (1.0 + 1e-12):
        raise ModelError(
            f"{what}: the angles span {math.degrees(span):.6g} degrees, a cycle has {math.degrees(period):g}; "
            "give radians, of one cycle"
        )
    if span >= period * (1.0 - 1e-12) and abs(y[-1] - y[0]) > CLOSED * float(np.abs(y).max()):
        raise ModelError(
            f"{what}: the cycle begins with {y[0]:g} Pa and ends with {y[-1]:g} Pa; as it repeats both must be equal"
        )
    if y.min() < 0.0:
        raise ModelError(f"{what}: pressures[{int(y.argmin())}] is {y.min():g} Pa; absolute pressures are not negative")
    ratio = None if compression is None else compression_given(what, compression)
    return PressureTable(tuple(x.tolist()), tuple(y.tolist()), int(turns), ratio)
