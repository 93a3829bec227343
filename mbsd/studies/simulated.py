"""``simulated(...)``: what a study measures by simulations, all points of a chunk in one compiled loop where it can."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from mbsd.base.arguments import checked
from mbsd.base.errors import ModelError
from mbsd.base.shown import shown
from mbsd.dynamics.many.designs import Designs, designs_of
from mbsd.dynamics.many.measures import Measure
from mbsd.dynamics.many.simulate_many import Simulations, asked_for, simulations
from mbsd.mechanism import Mechanism
from mbsd.studies.numbers_alone import MoreThanNumbers, differences

FEWEST = 8
"""Mechanisms that go together: what is made ready for all costs as much as some of them."""
FEW = "there are only a few points"
Numbers = tuple[dict[str, float] | None, str | None]
"""Numbers by name, or the reason why there are none."""


@dataclass(frozen=True)
class Simulated:
    """Measures of a simulation: the ``measure`` of a study, which knows how to measure many mechanisms at once."""

    measures: Mapping[str, Measure]
    duration: float | None = None
    steps: int = 360
    times: tuple[float, ...] | None = None
    method: str = "dop853"
    tolerance: float = 1e-7
    step: float | None = None
    formulation: str = "auto"
    options: Mapping[str, float] = field(default_factory=dict)

    def __call__(self, m: Mechanism) -> dict[str, float]:
        """Numbers of one mechanism. Raises ModelError with the reason why it has none."""
        [(values, reason)] = self.of_all([m])
        if values is None:
            raise ModelError(f"{m.name}: {reason}")
        return values

    def of_all(self, mechanisms: Sequence[Mechanism]) -> list[Numbers]:
        """Numbers of each mechanism, or why it has none."""
        try:
            return _rows(self._run(self._together(mechanisms, FEWEST)))
        except MoreThanNumbers:
            return [row for m in mechanisms for row in _rows(self._run(Designs(m, 1, {}, {}, {})))]

    def way(self, mechanisms: Sequence[Mechanism]) -> str:
        """How mechanisms like these are simulated, in words."""
        try:
            whys = [why for why in self._run(self._together(mechanisms, 2)).alone if why is not None]
        except MoreThanNumbers as why:
            return f"one by one: {why}"
        return f"one by one: {whys[0]}" if whys else "in one compiled loop"

    def _together(self, mechanisms: Sequence[Mechanism], fewest: int) -> Designs:
        if len(mechanisms) < fewest:
            raise MoreThanNumbers(FEW)
        return designs_of(mechanisms[0], differences(mechanisms), None, None)

    def _run(self, designs: Designs) -> Simulations:
        times = None if self.times is None else np.array(self.times)
        asked = asked_for(
            designs.m, self.duration, self.steps, times, self.method, self.tolerance, self.step, self.formulation,
            self.options,
        )  # fmt: skip
        return simulations(designs, self.measures, asked, 1, None)


def _rows(many: Simulations) -> list[Numbers]:
    flat = many.flat()
    return [
        ({name: float(column[k]) for name, column in flat.items()}, None) if reason is None else (None, reason)
        for k, reason in enumerate(many.reason)
    ]


@checked
def simulated(
    measures: Mapping[str, Measure],
    duration: float | None = None,
    steps: int = 360,
    times: Sequence[float] | np.ndarray | None = None,
    method: str = "dop853",
    tolerance: float = 1e-7,
    step: float | None = None,
    formulation: str = "auto",
    **options: float,
) -> Simulated:
    """What a study measures: ``study(build, grid, simulated({"end": final("door.theta")}, 4.0))``.

    ``measures``: names to measures (mbsd.measures); the other arguments are those of
    :meth:`mbsd.mechanism.Mechanism.simulate`. Where ``build`` makes mechanisms that differ in numbers of forces alone,
    they go through one compiled loop, as those of :meth:`mbsd.mechanism.Mechanism.simulate_many`; else
    one by one. ``table.attrs["way"]`` says which and why.
    Raises ModelError for measures that are none.
    """
    if not isinstance(measures, Mapping) or not measures or not all(isinstance(m, Measure) for m in measures.values()):
        raise ModelError(
            f"simulated: measures are {shown(measures)}; give names and measures, {{'end': final('door.theta')}}"
        )
    own = None if times is None else tuple(float(time) for time in times)
    return Simulated(dict(measures), duration, steps, own, method, tolerance, step, formulation, options)
