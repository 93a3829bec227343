"""``simulated(...)``: measures of a study by simulations, in one compiled loop where possible.

The loop holds all points of a chunk.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from mbsd.base.arguments import checked, described
from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.names import Suggesting, shown
from mbsd.dynamics.batch.designs import Built, Designs, designs_of
from mbsd.dynamics.batch.simulate_many import Simulations, checked_measures, quantities_of, simulations
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.runs.run import Request
from mbsd.dynamics.simulate import request_for
from mbsd.mechanism import Mechanism
from mbsd.model.mechanism import Model, connections
from mbsd.studies.numbers_alone import MoreThanNumbers, differences

FEWEST = 8
"""Mechanisms that go together: what is made ready for all costs as much as some of them."""
FEW = "there are only a few points"
INSTANT = 1e-9
"""s"""
Numbers = tuple[dict[str, float] | None, str | None]
"""Numbers by name, or the reason why there are none."""


@dataclass(frozen=True)
class Simulated(Suggesting):
    """Measures of a simulation, the ``measure`` of a study.

    It knows how to measure many mechanisms at once.
    """

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
        """Return numbers of one mechanism. Raises ModelError with the reason why it has none."""
        [(values, reason)] = self.of_all([m])
        if values is None:
            raise ModelError(f"{m.name}: {reason}")
        return values

    def of_all(self, mechanisms: Sequence[Mechanism]) -> list[Numbers]:
        """Return numbers of each mechanism, or why it has none: the same whichever others are beside it."""
        rows: dict[int, Numbers] = {
            number: (None, f"build gives {shown(m)}; it must give a Mechanism")
            for number, m in enumerate(mechanisms)
            if not isinstance(m, Model)
        }
        for numbers in alike(mechanisms):
            some = [mechanisms[number] for number in numbers]
            rows |= dict(zip(numbers, self._measured(some, _designs(some, FEWEST)), strict=True))
        return [rows[number] for number in range(len(mechanisms))]

    def way(self, mechanisms: Sequence[Mechanism]) -> str:
        """Return how mechanisms like these are simulated, in words."""
        runs = []
        for numbers in alike(mechanisms):
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    runs.append(self._run(_designs([mechanisms[number] for number in numbers], 2)))
            except MechanismError:
                continue  # that is their reason
        whys = [why for run in runs for why in run.alone if why is not None]
        if not runs or len(whys) == sum(map(len, runs)):
            return f"one by one: {whys[0] if whys else 'none starts'}"
        notes = [run.note for run in runs if run.note is not None]
        loop = "in one compiled loop" + (f", {notes[0]}" if notes else "")
        return f"{loop}; some one by one: {whys[0]}" if whys else loop

    def _measured(self, mechanisms: Sequence[Mechanism], designs: Designs) -> list[Numbers]:
        try:
            return _rows(self._run(designs))
        except MechanismError as error:  # none of them starts, or there is not what is measured
            if len(mechanisms) > 1:
                return [row for m in mechanisms for row in self._measured([m], Built([m], FEW))]
            if _starts(mechanisms[0]):
                raise
            return [(None, described(error))]

    def refuse(self, m: Mechanism) -> None:
        """Raise ModelError where no mechanism like this one can be simulated and measured so."""
        asked = self._request(m)
        measures = checked_measures(m, self.measures, asked.times)
        if isinstance(measures, Mapping) and _starts(m):
            quantities_of(Built([m], FEW), measures)

    def _request(self, m: Model) -> Request:
        times = None if self.times is None else np.array(self.times)
        return request_for(
            m, self.duration, self.steps, times, self.method, self.tolerance, self.step, self.formulation, self.options
        )

    def _run(self, designs: Designs) -> Simulations:
        return simulations(designs, self.measures, self._request(designs.m), 1, None)


def _designs(mechanisms: Sequence[Mechanism], fewest: int) -> Designs:
    """Return mechanisms by their numbers, if they differ in known numbers alone.

    Otherwise each is as it was built.
    """
    try:
        if len(mechanisms) < fewest:
            raise MoreThanNumbers(FEW)
        return replace(designs_of(mechanisms[0], differences(mechanisms), None, None), exact=True)
    except MoreThanNumbers as why:
        return Built(mechanisms, str(why))


def alike(mechanisms: Sequence[Mechanism]) -> list[list[int]]:
    """Return numbers of the mechanisms that have the same things by name."""
    out: dict[Any, list[int]] = {}
    for number, m in enumerate(mechanisms):
        if not isinstance(m, Model):
            continue
        kinds = [tuple((name, entry.kind.name) for name, entry in table.items()) for table in connections(m)]  # pyright: ignore[reportAttributeAccessIssue]
        out.setdefault((tuple(m.bodies), *kinds, tuple(m.traces)), []).append(number)
    return list(out.values())


def _starts(m: Mechanism) -> bool:
    try:
        m.simulate(INSTANT, steps=1)
    except MechanismError:
        return False
    return True


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
    """Return a study's ``measure``: ``study(build, grid, simulated({"end": final("door.theta")}, 4.0))``.

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
