"""A measured or computed pressure over the angle of the crank, repeated with the cycle.

p(phi)      cubic pieces through the points that keep their rises and falls (Fritsch, Carlson 1980), periodic
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd.base.arguments import number_array
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.cylinders.cycle import Bore, GasCycle, Phase, compression_given

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
    x, y = number_array(f"{what}: angles", angles), number_array(f"{what}: pressures", pressures)
    if x.ndim != 1 or x.shape != y.shape or len(x) < FEWEST:
        raise ModelError(
            f"{what}: angles {x.shape} and pressures {y.shape} must be two lists of {FEWEST} numbers or more"
        )
    if isinstance(turns, bool) or turns not in (1, 2):
        raise ModelError(f"{what}: turns is {shown(turns)}; a cycle has 2 turns of the crank (four strokes) or 1 (two)")
    if not (np.diff(x) > 0).all():
        raise ModelError(f"{what}: angles must rise; angles[{int(np.argmin(np.diff(x) > 0)) + 1}] does not")
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
