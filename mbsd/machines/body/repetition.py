"""One repetition of an exercise: up, a pause, down, a pause, again and again.

    f = bottom + (top - bottom) s(u),  s = 10 u^3 - 15 u^4 + 6 u^5,  u = (t - begin) / duration

s has the least jerk of all motions from rest to rest. Source: T. Flash, N. Hogan, J. Neurosci. 5 (1985) 1688.
"""

from __future__ import annotations

from dataclasses import dataclass

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.model.laws import Motion
from mbsd.model.laws.function import function


@dataclass(frozen=True)
class Tempo:
    """How long each phase lasts (s): up from the bottom, at the top, down, at the bottom."""

    up: float = 1.0
    hold: float = 0.5
    down: float = 1.5
    rest: float = 0.5

    def __post_init__(self) -> None:
        for name in ("up", "hold", "down", "rest"):
            number = finite_number(f"tempo: {name}", getattr(self, name))
            if number < 0 or (number == 0 and name in ("up", "down")):
                raise ModelError(
                    f"tempo: {name} is {number:g} s; a phase that moves takes time, a pause has none below 0"
                )

    @property
    def period(self) -> float:
        """Duration of a whole repetition (s)."""
        return self.up + self.hold + self.down + self.rest

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times (s) at which a phase begins, within a repetition."""
        return self.up, self.up + self.hold, self.up + self.hold + self.down

    def part(self, time: float) -> tuple[float, float, float]:
        """How much of the way from bottom to top is made at a time (s), with rate (1/s) and acceleration (1/s^2)."""
        t = time % self.period
        _, begin, end = self.breaks
        if t >= end:
            return 0.0, 0.0, 0.0
        if t >= begin:
            s, ds, dds = _least_jerk((t - begin) / self.down)
            return 1.0 - s, -ds / self.down, -dds / self.down**2
        s, ds, dds = _least_jerk(min(t / self.up, 1.0))
        return s, ds / self.up, dds / self.up**2


def repetition(bottom: float, top: float, tempo: Tempo) -> Motion:
    """The law (rad or m) of a repetition that begins at the bottom; a law that holds where both ends are the same."""
    way = top - bottom
    if way == 0.0:
        from mbsd.model.laws.formulas import polynomial

        return polynomial(bottom)
    return function(
        lambda t: bottom + way * tempo.part(t)[0],
        lambda t: way * tempo.part(t)[1],
        lambda t: way * tempo.part(t)[2],
        period=tempo.period,
        breaks=tempo.breaks,
        shortest=min(tempo.up, tempo.down),
    )


def _least_jerk(u: float) -> tuple[float, float, float]:
    return (
        u**3 * (10.0 + u * (-15.0 + 6.0 * u)),
        30.0 * u**2 * (1.0 - u) ** 2,
        60.0 * u * (1.0 - u) * (1.0 - 2.0 * u),
    )
